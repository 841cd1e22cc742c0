// SPDX-License-Identifier: Apache-2.0
#include "quintic_spline.hpp"

#include <gtest/gtest.h>

#include "armature/kinds/trajectory/contract.hpp"

namespace armature::trajectory::quintic_spline {
namespace {

INSTANTIATE_TEST_SUITE_P(QuinticSpline, TrajectoryLaws,
                         testing::Values(TrajectorySubject{
                             "quintic_spline", std::make_shared<QuinticSplineTrajectory>()}),
                         testing::PrintToStringParamName());

}  // namespace
}  // namespace armature::trajectory::quintic_spline
