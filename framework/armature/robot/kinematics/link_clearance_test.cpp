// SPDX-License-Identifier: Apache-2.0
// How near the links of an arm come to forbidden zones: 1. at one posture, against points sampled
// on both, 2. on a trajectory, where nothing is stepped over.
#include "armature/robot/kinematics/link_clearance.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <random>
#include <vector>

#include "armature/robot/kinematics/kinematics.hpp"

namespace armature {
namespace {

using Eigen::Vector3d;

const RobotModel& sr1() {
  static const RobotModel model =
      load_robot_model(ARMATURE_SOURCE_DIR "/configs/robots/sr1_needle.yaml");
  return model;
}

JointVector random_joints(std::mt19937_64& random) {
  JointVector q(sr1().dof());
  for (int i = 0; i < sr1().dof(); ++i) {
    q[i] = std::uniform_real_distribution<double>{sr1().lower()[i], sr1().upper()[i]}(random);
  }
  return q;
}

/// The least distance between points on the middle lines of all capsules and of the zone.
double sampled(const JointVector& q, const ForbiddenZone& zone) {
  constexpr int kPoints = 100;
  std::vector<Eigen::Isometry3d> frames(static_cast<std::size_t>(sr1().joint_count()));
  joint_frames(sr1(), q, frames);
  double least = std::numeric_limits<double>::infinity();
  for (const LinkCapsule& capsule : sr1().capsules()) {
    const Eigen::Isometry3d base_T_link =
        capsule.parent_joint < 0 ? Eigen::Isometry3d::Identity()
                                 : frames[static_cast<std::size_t>(capsule.parent_joint)];
    for (int i = 0; i <= kPoints; ++i) {
      const Vector3d a =
          base_T_link * Vector3d{capsule.from + (capsule.to - capsule.from) * i / kPoints};
      for (int k = 0; k <= kPoints; ++k) {
        const Vector3d b = zone.from + (zone.to - zone.from) * k / kPoints;
        least = std::min(least, (a - b).norm() - capsule.radius - zone.radius_m);
      }
    }
  }
  return least;
}

TEST(LinkClearance, IsThatOfPointsSampledOnLinksAndZones) {
  SCOPED_TRACE("seed 21");
  std::mt19937_64 random{21};
  std::normal_distribution<double> normal;
  const auto point = [&] { return Vector3d{normal(random), normal(random), normal(random)} * 0.5; };
  for (int i = 0; i < 30; ++i) {
    const JointVector q = random_joints(random);
    ForbiddenZone zone{"zone", point(), {}, 0.03};
    zone.to = i % 3 == 0 ? zone.from : Vector3d{zone.from + 0.3 * point()};
    const auto found = link_clearance(sr1(), q, std::array{zone});
    ASSERT_TRUE(found);
    const double searched = sampled(q, zone);
    EXPECT_LE(found->distance_m, searched + 1e-12) << i;
    EXPECT_GE(found->distance_m, searched - 0.006) << i << ": as near as the points are";
  }
}

TEST(LinkClearance, NamesTheLinkAndTheZone) {
  const JointVector home = resting_position(sr1());
  const std::vector<ForbiddenZone> zones{{"far", {3, 0, 0}, {3, 0, 0}, 0.1},
                                         {"foot", {0.5, 0, -0.6}, {0.5, 0, -0.6}, 0.1}};
  const auto found = link_clearance(sr1(), home, zones);
  ASSERT_TRUE(found);
  EXPECT_EQ(found->zone, 1u);
  const ForbiddenZone alone = zones[1];
  EXPECT_NEAR(found->distance_m, sampled(home, alone), 0.006);
  EXPECT_FALSE(link_clearance(sr1(), home, {})) << "no zone";
}

/// From `from` to `to` in `duration_s`, all joints by one quintic.
Trajectory move(const JointVector& from, const JointVector& to, double duration_s) {
  Trajectory trajectory{.dof = static_cast<int>(from.size()), .knots = {0, duration_s}};
  for (Eigen::Index i = 0; i < from.size(); ++i) {
    trajectory.pieces.push_back(Quintic::between({from[i], 0, 0}, {to[i], 0, 0}, duration_s));
  }
  return trajectory;
}

TEST(LinkClearance, ATrajectoryIsClearWhereADenseSearchFindsItClear) {
  SCOPED_TRACE("seed 22");
  std::mt19937_64 random{22};
  std::normal_distribution<double> normal;
  constexpr double kMargin_m = 0.005, kBetween_m = 5e-5, kDuration_s = 2;
  int clear = 0, hit = 0;
  for (int i = 0; i < 100; ++i) {
    const Trajectory trajectory = move(random_joints(random), random_joints(random), kDuration_s);
    const Vector3d place = 0.5 * Vector3d{normal(random), normal(random), normal(random)};
    const std::vector<ForbiddenZone> zones{{"ball", place, place, 0.05}};
    double least = std::numeric_limits<double>::infinity();
    for (double t = 0; t <= kDuration_s; t += 2e-4) {
      least = std::min(least,
                       link_clearance(sr1(), state_at(trajectory.view(), t).q, zones)->distance_m);
    }
    const auto found = first_violation(sr1(), trajectory.view(), zones, kMargin_m);
    if (found) {
      ++hit;
      EXPECT_LT(found->where.distance_m, kMargin_m) << i;
      EXPECT_NEAR(
          link_clearance(sr1(), state_at(trajectory.view(), found->t_s).q, zones)->distance_m,
          found->where.distance_m, 1e-12)
          << i;
    } else {
      ++clear;
      EXPECT_GE(least, kMargin_m - kBetween_m) << i;
    }
  }
  EXPECT_GT(clear, 10);
  EXPECT_GT(hit, 10);
}

TEST(LinkClearance, AThinZoneThatAFastLinkSweepsThroughIsNotSteppedOver) {
  JointVector from = resting_position(sr1());
  JointVector to = from;
  to[0] += 2.0;
  const JointVector middle = 0.5 * (from + to);
  const Vector3d tip = forward_kinematics(sr1(), middle).translation();
  const std::vector<ForbiddenZone> thread{{"thread", tip, tip, 0}};
  const Trajectory fast = move(from, to, 0.01);
  const auto found = first_violation(sr1(), fast.view(), thread, 0.0002);
  ASSERT_TRUE(found);
  EXPECT_EQ(sr1().capsules()[found->where.capsule].name, "needle");
  EXPECT_NEAR(found->t_s, 0.005, 1e-4);
}

TEST(LinkClearance, AZoneThatTheToolEntersIsLeftToTheNeedleFromItsTimeOnAndToNoOtherLink) {
  JointVector out = resting_position(sr1());
  JointVector in = out;
  in[0] += 0.4;
  const Trajectory trajectory = move(out, in, 1);
  const Vector3d tip = forward_kinematics(sr1(), in).translation();
  const auto found = [&](double radius, bool tool_enters, double from_s) {
    const std::vector<ForbiddenZone> zones{{"head", tip, tip, radius, tool_enters}};
    const auto violation = first_violation(sr1(), trajectory.view(), zones, 0.002, from_s);
    return violation ? sr1().capsules()[violation->where.capsule].name : "";
  };
  EXPECT_EQ(found(0.02, true, 0), "");
  EXPECT_EQ(found(0.02, false, 0), "needle") << "no tool enters it";
  EXPECT_EQ(found(0.02, true, 1.5), "needle") << "not yet";
  EXPECT_EQ(found(0.02, true, kToolEntersNothing), "needle");
  EXPECT_NE(found(0.25, true, 0), "") << "the wrist is no tool";
}

TEST(LinkClearance, WhatIsNotANumberIsNotClear) {
  const JointVector home = resting_position(sr1());
  Trajectory trajectory = move(home, home, 1);
  trajectory.pieces[0].c[0] = NAN;
  const std::vector<ForbiddenZone> zones{{"far", {3, 0, 0}, {3, 0, 0}, 0.1}};
  EXPECT_TRUE(first_violation(sr1(), trajectory.view(), zones, 0.002));
}

}  // namespace
}  // namespace armature
