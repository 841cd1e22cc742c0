// SPDX-License-Identifier: Apache-2.0
// 1. A short trajectory is read as any other. 2. Its moves keep the limits and are as fast as they
// allow. 3. It knows when it is full.
#include "armature/robot/trajectories/short_trajectory.hpp"

#include <gtest/gtest.h>

namespace armature {
namespace {

JointVector joints(double a, double b, double c) { return Eigen::Vector3d{a, b, c}; }

const JointVector kMaxVelocity = joints(1, 2, 3), kMaxAcceleration = joints(2, 4, 6);

JointState moving() {
  return {.q = joints(0.1, 0.2, 0.3), .v = joints(0.5, -1, 0.2), .a = joints(1, 0, -2)};
}

TEST(ShortTrajectory, IsReadAsTheTrajectoryThatItIsCopiedTo) {
  const ShortTrajectory stop =
      short_stop_from(moving(), kMaxVelocity, kMaxAcceleration, Time{5000}, 7);
  const Trajectory copy = to_trajectory(stop.view());
  EXPECT_EQ(copy.goal_id, 7u);
  ASSERT_EQ(copy.piece_count(), stop.pieces);
  for (double t = -0.1; t < copy.duration_s() + 0.1; t += 0.01) {
    const Time time = copy.start + seconds(t);
    EXPECT_EQ(copy.at(time).q, stop.view().at(time).q) << t;
    EXPECT_EQ(copy.at(time).v, stop.view().at(time).v) << t;
    EXPECT_EQ(copy.at(time).a, stop.view().at(time).a) << t;
  }
}

TEST(ShortTrajectory, StaysWhereItHolds) {
  const ShortTrajectory hold = short_hold_at(joints(1, 2, 3), Time{100}, 1);
  EXPECT_EQ(hold.view().end(), Time{100});
  EXPECT_EQ(hold.view().at(Time{5000}).q, joints(1, 2, 3));
  EXPECT_TRUE(at_rest(hold.view().at(Time{0})));
}

TEST(ShortTrajectory, MovesFromRestToRestAsFastAsTheLimitsAllow) {
  for (const double way : {1e-4, 0.1, 3.0}) {
    const JointVector to = joints(way, -way, way / 2);
    const Trajectory move = to_trajectory(
        short_move(joints(0, 0, 0), to, kMaxVelocity, kMaxAcceleration, Time{0}, 1).view());
    EXPECT_TRUE(move.at(move.end()).q.isApprox(to, 1e-12));
    EXPECT_TRUE(at_rest(move.at(move.start)) && at_rest(move.at(move.end())));
    const LimitUse use = limit_use(move, kMaxVelocity, kMaxAcceleration);
    EXPECT_LE(std::max(use.velocity, use.acceleration), 1);
    if (move.duration_s() > 0.011) {
      EXPECT_GT(std::max(use.velocity, use.acceleration), 1 - 1e-6);
    }
  }
}

TEST(ShortTrajectory, GoesOnWithAnotherOneWhereItEnds) {
  ShortTrajectory stop = short_stop_from(moving(), kMaxVelocity, kMaxAcceleration, Time{0}, 1);
  const Time rests = stop.view().end();
  const JointVector from = stop.view().at(rests).q;
  ASSERT_TRUE(
      stop.append(short_move(from, joints(0, 0, 0), kMaxVelocity, kMaxAcceleration, rests, 1)));
  EXPECT_TRUE(stop.view().at(rests).q.isApprox(from, 1e-9));
  EXPECT_LT(stop.view().at(stop.view().end()).q.norm(), 1e-12);
}

TEST(ShortTrajectory, TakesNoMorePiecesThanItHasRoomFor) {
  ShortTrajectory full = short_hold_at(joints(0, 0, 0), Time{0}, 1);
  while (full.add_piece(0.1)) {
  }
  EXPECT_EQ(full.pieces, ShortTrajectory::kMaxPieces);
  EXPECT_FALSE(full.append(short_hold_at(joints(0, 0, 0), Time{0}, 1)));
  EXPECT_EQ(full.pieces, ShortTrajectory::kMaxPieces);
}

}  // namespace
}  // namespace armature
