// SPDX-License-Identifier: Apache-2.0
// The same file in two processes, over DDS.
#include <gtest/gtest.h>

#include "deployment_run.hpp"

namespace armature::test {
namespace {

TEST(TwoProcesses, MeetTheSameGoalsOverDds) {
  DeploymentStart start{.settings = kVisionApart};
  start.settings.push_back("run.time_limit_s=150");  // on the system clock of a busy machine
  expect_aligned(run_deployment(start));
}

}  // namespace
}  // namespace armature::test
