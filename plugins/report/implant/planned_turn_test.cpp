// SPDX-License-Identifier: Apache-2.0
// How smooth a planned turn is at its keys, by its samples alone.
#include "planned_turn.hpp"

#include <gtest/gtest.h>

#include "armature/robot/orientations/orientation_curve.hpp"

namespace armature::report::implant {
namespace {

using Eigen::Quaterniond;
using Eigen::Vector3d;

/// Three keys, a sixth of a turn and more from one to the next, sampled `parts` times an arc.
PlannedTurn turn_by(OrientationInterpolator interpolator, int parts) {
  const std::vector<Quaterniond> keys{
      Quaterniond{Eigen::AngleAxisd{0.9, Vector3d{1, 1, 3}.normalized()}},
      Quaterniond{Eigen::AngleAxisd{1.1, Vector3d::UnitX()}},
      Quaterniond{Eigen::AngleAxisd{0.6, Vector3d::UnitY()}}};
  const auto curve =
      OrientationCurve::through(keys, interpolator, std::vector<double>{0, 0.5, 1}).value();
  std::vector<TurnSample> samples;
  for (int i = 0; i <= 2 * parts; ++i) {
    const double s = 0.5 * i / parts;
    samples.push_back({s, curve.at(s).rotation});
  }
  return {samples, std::vector{static_cast<std::size_t>(parts)}};
}

TEST(PlannedTurn, ShowsACornerAndAJumpOfTheAccelerationAndNoneOnSmoothCurves) {
  for (const int parts : {80, 160, 320}) {
    SCOPED_TRACE(parts);
    EXPECT_GT(turn_by(OrientationInterpolator::slerp, parts).jump_of_peak(), 0.5);
    EXPECT_GT(turn_by(OrientationInterpolator::squad, parts).jump_of_peak(), 0.05);
    EXPECT_LT(turn_by(OrientationInterpolator::rotvec_bspline, parts).jump_of_peak(), 0.01);
    EXPECT_LT(turn_by(OrientationInterpolator::chart_bspline, parts).jump_of_peak(), 0.01);
  }
}

TEST(PlannedTurn, LeavesOutKeysWithoutThreeSamplesOnEitherSide) {
  std::vector<TurnSample> samples;
  for (int i = 0; i <= 6; ++i) {
    samples.push_back({0.1 * i, Quaterniond{Eigen::AngleAxisd{0.01 * i, Vector3d::UnitZ()}}});
  }
  const std::vector<std::size_t> keys{0, 2, 3, 4, 6};
  const PlannedTurn turn{samples, keys};
  EXPECT_EQ(turn.keys_seen(), 1u);
  EXPECT_NEAR(turn.total_rad(), 0.06, 1e-12);
  EXPECT_NEAR(turn.jump_of_peak(), 0, 1e-6);
}

TEST(PlannedTurn, DoesNotLookBeyondTheEndOfASegment) {
  std::vector<TurnSample> samples;
  for (int segment = 0; segment < 2; ++segment) {
    for (int i = 0; i <= 3; ++i) {
      samples.push_back({i / 3.0, Quaterniond{Eigen::AngleAxisd{0.1 * i, Vector3d::UnitZ()}}});
    }
  }
  EXPECT_EQ((PlannedTurn{samples, std::vector<std::size_t>{4}}.keys_seen()), 0u);
}

TEST(PlannedTurn, OfNothingIsNoTurn) {
  const PlannedTurn none{{}, {}};
  EXPECT_EQ(none.total_rad(), 0);
  EXPECT_EQ(none.jump_of_peak(), 0);
}

}  // namespace
}  // namespace armature::report::implant
