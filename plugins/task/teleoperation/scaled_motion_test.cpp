// SPDX-License-Identifier: Apache-2.0
// The follower's moves from the hand's: 1. scaled and turned into its frame, 2. closing the clutch
// moves nothing, 3. its speed, 4. about an incision.
#include "scaled_motion.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <optional>

#include "hand_period.hpp"

namespace armature::task::teleoperation {
namespace {

using Eigen::Vector3d;

Eigen::Isometry3d turned_pose(const Vector3d& position, double angle, const Vector3d& axis) {
  return Eigen::Translation3d{position} * Eigen::AngleAxisd{angle, axis.normalized()};
}
double angle_between(const Eigen::Isometry3d& a, const Eigen::Isometry3d& b) {
  return Eigen::AngleAxisd{a.linear() * b.linear().transpose()}.angle();
}

class ScaledMotionTest : public testing::Test {
 protected:
  /// Engages at hand(0) and follows it for `duration`; every step is looked at.
  FollowerTarget follow(const std::function<Eigen::Isometry3d(double)>& hand, double duration,
                        Parameters parameters = {.scale = 0.5, .engage = 0},
                        const std::optional<Vector3d>& incision = {}) {
    ScaledMotion motion{parameters};
    motion.engage(follower_, hand(0), turn_, incision);
    FollowerTarget last{.pose = follower_};
    for (int k = 1; k * kHandPeriod_s < duration + kHandPeriod_s / 2; ++k) {
      const FollowerTarget target = motion.follow(hand(k * kHandPeriod_s));
      const Vector3d step = target.pose.translation() - last.pose.translation();
      EXPECT_LT((step - kHandPeriod_s * target.velocity).norm(), 1e-15) << k;
      const Eigen::AngleAxisd turned{target.pose.linear() * last.pose.linear().transpose()};
      EXPECT_LT((turned.angle() * turned.axis() - kHandPeriod_s * target.angular_velocity).norm(),
                1e-9);
      if (incision) look_at_shaft(target.pose, *incision);
      fastest_ = std::max(fastest_, target.velocity.norm());
      hardest_ = std::max(hardest_, (target.velocity - last.velocity).norm() / kHandPeriod_s);
      last = target;
    }
    return last;
  }

  /// The follower's shaft lies along its z.
  void look_at_shaft(const Eigen::Isometry3d& pose, const Vector3d& incision) {
    const Vector3d out = pose.translation() - incision;
    farthest_ = std::max(farthest_, out.cross(pose.linear().col(2)).norm());
    least_depth_ = std::min(least_depth_, out.dot(pose.linear().col(2)));
  }

  const Eigen::Isometry3d follower_ = turned_pose({0.5, 0.1, 0.2}, 1, {1, 2, 3});
  const Eigen::Isometry3d hand_ = turned_pose({0.1, 0.1, 0.1}, 2, {-1, 0, 3});
  const Eigen::Matrix3d turn_{Eigen::AngleAxisd{M_PI / 2, Vector3d::UnitZ()}};
  double fastest_ = 0, hardest_ = 0;
  double farthest_ = 0, least_depth_ = 1;  // of the shaft from the incision, of the tip behind it
};

TEST_F(ScaledMotionTest, TheFollowerGoesItsPartOfTheHandsWayInItsOwnFrame) {
  const auto hand = [&](double t) {
    Eigen::Isometry3d pose = hand_;
    pose.translation() += Vector3d{0.02 * t, -0.01 * t, 0.03 * t};
    return pose;
  };
  const FollowerTarget target = follow(hand, 1);
  const Vector3d wanted = follower_.translation() + 0.5 * Vector3d{0.01, 0.02, 0.03};
  EXPECT_LT((target.pose.translation() - wanted).norm(), 1e-12);
  EXPECT_LT((target.velocity - 0.5 * Vector3d{0.01, 0.02, 0.03}).norm(), 1e-9);
  EXPECT_LT(angle_between(target.pose, follower_), 1e-12);
}

TEST_F(ScaledMotionTest, TurnsAreAboutTheSameAxesInSpaceAndNotScaled) {
  const auto hand = [&](double t) {
    Eigen::Isometry3d pose = hand_;
    pose.linear() = Eigen::AngleAxisd{0.4 * t, Vector3d::UnitX()} * hand_.linear();
    return pose;
  };
  const FollowerTarget target = follow(hand, 1);
  Eigen::Isometry3d wanted = follower_;
  wanted.linear() = Eigen::AngleAxisd{0.4, Vector3d::UnitY()} * follower_.linear();
  EXPECT_LT(angle_between(target.pose, wanted), 1e-9);
  EXPECT_LT((target.angular_velocity - Vector3d{0, 0.4, 0}).norm(), 1e-9);
  EXPECT_LT((target.pose.translation() - follower_.translation()).norm(), 1e-15);
}

TEST_F(ScaledMotionTest, ClosingTheClutchMovesNothingWhereverTheHandIs) {
  const FollowerTarget target = follow([&](double) { return hand_; }, 0.1);
  EXPECT_LT((target.pose.translation() - follower_.translation()).norm(), 1e-15);
  EXPECT_LT(angle_between(target.pose, follower_), 1e-9);
  EXPECT_EQ(fastest_, 0);
}

TEST_F(ScaledMotionTest, OnAMovingHandTheScaleComesUpSmoothly) {
  const auto hand = [&](double t) {
    Eigen::Isometry3d pose = hand_;
    pose.translation().x() += 0.04 * t;
    return pose;
  };
  const FollowerTarget target = follow(hand, 1, {.scale = 0.5, .engage = 0.3});
  EXPECT_NEAR(target.velocity.norm(), 0.02, 1e-9);
  EXPECT_LT(hardest_, 1.9 * 0.02 / 0.3) << "the quintic's steepest slope is 1.875";
  EXPECT_NEAR((target.pose.translation() - follower_.translation()).norm(), 0.02 * 0.85, 2e-5);
}

TEST_F(ScaledMotionTest, MissedPosesOfTheHandMakeItNoFaster) {
  ScaledMotion motion{{.scale = 0.5, .engage = 0, .max_tip_speed = 0.05}};
  motion.engage(follower_, hand_, turn_);
  Eigen::Isometry3d hand = hand_;
  hand.translation().x() += 0.0004;
  hand.linear() = Eigen::AngleAxisd{0.01, Vector3d::UnitX()} * hand.linear();
  const FollowerTarget target = motion.follow(hand, 8);
  EXPECT_NEAR(target.velocity.norm(), 0.025, 1e-12);
  EXPECT_NEAR(target.angular_velocity.norm(), 1.25, 1e-9);
  EXPECT_NEAR((target.pose.translation() - follower_.translation()).norm(), 0.0002, 1e-15);
}

TEST_F(ScaledMotionTest, ItsSpeedKeepsItsLimitAndItStopsWithTheHand) {
  const auto hand = [&](double t) {
    Eigen::Isometry3d pose = hand_;
    pose.translation().x() += 0.2 * std::min(t, 0.5);  // 200 mm/s, then at rest
    return pose;
  };
  const FollowerTarget target = follow(hand, 1, {.scale = 0.5, .engage = 0, .max_tip_speed = 0.05});
  EXPECT_LE(fastest_, 0.05);
  EXPECT_GT(fastest_, 0.049);
  EXPECT_EQ(target.velocity.norm(), 0) << "what was lost is not made up for";
  EXPECT_LE((target.pose.translation() - follower_.translation()).norm(), 0.025 + 1e-12);
}

TEST_F(ScaledMotionTest, UpToFourFifthsOfTheLimitNothingIsLost) {
  const auto hand = [&](double t) {
    Eigen::Isometry3d pose = hand_;
    pose.translation().z() += 0.0799 * t;
    return pose;
  };
  const FollowerTarget target = follow(hand, 1, {.scale = 0.5, .engage = 0, .max_tip_speed = 0.05});
  EXPECT_NEAR(target.velocity.z(), 0.03995, 1e-9);
}

TEST_F(ScaledMotionTest, AboutAnIncisionTheTipGoesWithTheHandAndTheShaftThroughThePoint) {
  const Vector3d incision = follower_ * Vector3d{0, 0, -0.1};
  const auto hand = [&](double t) {
    Eigen::Isometry3d pose = hand_ * Eigen::AngleAxisd{0.5 * std::sin(3 * t), Vector3d::UnitX()};
    pose.translation() += Vector3d{0.04 * std::sin(t), 0.03 * t, -0.02 * std::sin(2 * t)};
    return pose;
  };
  const FollowerTarget target =
      follow(hand, 2, {.scale = 0.5, .engage = 0, .max_tip_speed = 1, .max_tilt = 10}, incision);
  const Vector3d moved = turn_ * (hand(2).translation() - hand(0).translation());
  EXPECT_LT((target.pose.translation() - follower_.translation() - 0.5 * moved).norm(), 1e-12);
  EXPECT_LT(farthest_, 1e-12);
}

TEST_F(ScaledMotionTest, AboutAnIncisionTheShaftRollsWithTheHandAndDoesNotTurnOtherwise) {
  const Vector3d incision = follower_ * Vector3d{0, 0, -0.1};
  const Vector3d shaft = turn_.transpose() * follower_.linear().col(2);  // as the hand sees it
  const auto turning_about = [&](const Vector3d& axis) {
    return follow(
        [&](double t) {
          Eigen::Isometry3d pose = hand_;
          pose.linear() = Eigen::AngleAxisd{0.4 * t, axis} * hand_.linear();
          return pose;
        },
        1, {.scale = 0.5, .engage = 0}, incision);
  };
  EXPECT_NEAR(angle_between(turning_about(shaft).pose, follower_), 0.4, 1e-9);
  EXPECT_NEAR(angle_between(turning_about(shaft.unitOrthogonal()).pose, follower_), 0, 1e-9);
}

TEST_F(ScaledMotionTest, TheTipIsNotBroughtNearerToTheIncisionThanTheLeastDepth) {
  const Vector3d incision = follower_ * Vector3d{0, 0, -0.03};
  const Vector3d outward = turn_.transpose() * -follower_.linear().col(2);
  const auto hand = [&](double t) {
    Eigen::Isometry3d pose = hand_;
    pose.translation() += 0.1 * t * outward;
    return pose;
  };
  follow(hand, 4, {.scale = 0.5, .engage = 0, .min_depth = 0.01}, incision);
  EXPECT_GT(least_depth_, 0.01);
  EXPECT_LT(least_depth_, 0.0101);
  EXPECT_LT(farthest_, 1e-12);
}

TEST_F(ScaledMotionTest, NearTheIncisionTheTipIsSlowerByTheTilt) {
  const Vector3d incision = follower_ * Vector3d{0, 0, -0.02};
  const auto hand = [&](double t) {
    Eigen::Isometry3d pose = hand_;
    pose.translation().x() += 0.2 * t;
    return pose;
  };
  follow(hand, 0.1, {.scale = 0.5, .engage = 0, .max_tip_speed = 1, .max_tilt = 1}, incision);
  EXPECT_LE(fastest_, 0.025);
  EXPECT_GT(fastest_, 0.018);
}

}  // namespace
}  // namespace armature::task::teleoperation
