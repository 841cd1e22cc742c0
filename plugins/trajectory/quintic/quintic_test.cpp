// SPDX-License-Identifier: Apache-2.0
#include "quintic.hpp"

#include <gtest/gtest.h>

#include "armature/kinds/trajectory/contract.hpp"

namespace armature::trajectory::quintic {
namespace {

INSTANTIATE_TEST_SUITE_P(Quintic, TrajectoryLaws,
                         testing::Values(TrajectorySubject{"quintic",
                                                           std::make_shared<QuinticTrajectory>()}),
                         testing::PrintToStringParamName());

}  // namespace
}  // namespace armature::trajectory::quintic
