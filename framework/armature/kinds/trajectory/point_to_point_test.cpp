// SPDX-License-Identifier: Apache-2.0
#include "armature/kinds/trajectory/point_to_point.hpp"

#include <gtest/gtest.h>

#include <random>

namespace armature {
namespace {

class PointToPoint : public testing::Test {
 protected:
  JointVector random_vector(double size) {
    JointVector v(6);
    for (double& x : v) x = size * uniform_(random_);
    return v;
  }
  TrajectoryRequest random_line() {
    const JointVector from = random_vector(2), to = random_vector(2), zero = JointVector::Zero(6);
    return {.goal_id = 3,
            .start = Time{7},
            .from = {from, zero, zero},
            .segments = {{.s = {0, 1}, .q = {from, to}}},
            .max_velocity = random_vector(1).cwiseAbs().array() + 0.1,
            .max_acceleration = random_vector(4).cwiseAbs().array() + 0.1};
  }

  static constexpr unsigned kSeed = 5;
  std::mt19937_64 random_{kSeed};
  std::uniform_real_distribution<double> uniform_{-1, 1};
};

TEST_F(PointToPoint, GoesFromRestToRestAndReachesALimitWithoutPassingAny) {
  for (int i = 0; i < 1000; ++i) {
    const TrajectoryRequest request = random_line();
    const auto planned = point_to_point(request);
    ASSERT_TRUE(planned) << "seed " << kSeed << ", line " << i;
    EXPECT_EQ(planned->goal_id, 3u);
    EXPECT_EQ(planned->start, Time{7});
    const LimitUse use = limit_use(*planned, request.max_velocity, request.max_acceleration);
    EXPECT_LE(std::max(use.velocity, use.acceleration), 1);
    EXPECT_GE(std::max(use.velocity, use.acceleration), 1 - 1e-8);
    const JointState first = planned->at(planned->start), last = planned->at(planned->end());
    EXPECT_EQ(first.q, request.from.q);
    EXPECT_LT((last.q - request.segments[0].q[1]).norm(), 1e-12);
    for (const JointState& end : {first, last}) {
      EXPECT_LT(end.v.norm(), 1e-12);
      EXPECT_LT(end.a.norm(), 1e-10);
    }
  }
}

TEST_F(PointToPoint, KeepsTheSegmentsOwnDurationWhenTheLimitsAllowIt) {
  TrajectoryRequest request = random_line();
  const double shortest = point_to_point(request)->duration_s();
  request.segments[0].duration_s = 1.5 * shortest;
  EXPECT_EQ(point_to_point(request)->duration_s(), 1.5 * shortest);
  request.segments[0].duration_s = 0.99 * shortest;
  EXPECT_FALSE(point_to_point(request));
}

TEST_F(PointToPoint, ATinyWayTakesTwentyMilliseconds) {
  TrajectoryRequest request = random_line();
  request.segments[0].q[1] = request.segments[0].q[0].array() + 1e-9;
  EXPECT_DOUBLE_EQ(point_to_point(request)->duration_s(), 0.02);
}

TEST_F(PointToPoint, LeavesEveryOtherRequestToOthers) {
  TrajectoryRequest moving = random_line();
  moving.from.v[2] = 0.1;
  EXPECT_FALSE(point_to_point(moving));
  TrajectoryRequest nowhere = random_line();
  nowhere.segments[0].q[1] = nowhere.segments[0].q[0];
  EXPECT_FALSE(point_to_point(nowhere));
  TrajectoryRequest two = random_line();
  two.segments.push_back(two.segments[0]);
  EXPECT_FALSE(point_to_point(two));
  TrajectoryRequest wrong = random_line();
  wrong.segments[0].q[1][0] = NAN;
  EXPECT_FALSE(point_to_point(wrong));
}

}  // namespace
}  // namespace armature
