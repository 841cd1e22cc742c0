// SPDX-License-Identifier: Apache-2.0
// The same file in two processes, over DDS.
#include <gtest/gtest.h>

#include "lamp_run.hpp"

namespace armature::test {
namespace {

TEST(TwoProcesses, MeetTheSameGoalsOverDds) {
  LampStart start{.settings = kVisionApart};
  start.settings.push_back("run.time_limit_s=150");  // on the system clock of a busy machine
  expect_aligned(run_lamp(start));
}

}  // namespace
}  // namespace armature::test
