// SPDX-License-Identifier: Apache-2.0
// Where axis 1 runs along the slide, joint 1 is free: the limits are kept where they can be.
#include <gtest/gtest.h>

#include "armature/robot/kinematics/kinematics.hpp"
#include "rrp_test_arms.hpp"

namespace armature {
namespace {

constexpr std::uint64_t kFreeBaseSeed = 20261127;
constexpr int kFreeBasePoses = 1000;

/// The master manipulator or another one with turns of joints 1, 4 and 6 that are this narrow, and
/// of joint 5; joint 2 turns all the way.
std::shared_ptr<const RobotModel> narrow_arm(double alpha3, double half_range, double half_range5) {
  return testing::changed_master([=](auto& joints, auto&) {
    testing::turn_all_the_way(joints);
    joints[3].alpha = alpha3;
    for (const std::size_t i : {0U, 3U, 5U}) {
      joints[i].lower = -half_range;
      joints[i].upper = half_range + 0.1;
    }
    joints[4].lower = -half_range5;
    joints[4].upper = half_range5;
  });
}

struct FreeBase {
  std::string name;
  std::shared_ptr<const RobotModel> arm;
  bool wrist_straight;

  friend void PrintTo(const FreeBase& one, std::ostream* out) { *out << one.name; }
};

std::vector<FreeBase> free_bases() {
  std::vector<FreeBase> all;
  for (const double alpha3 : {0.0, M_PI, M_PI / 2, -M_PI / 2}) {
    for (const bool straight : {false, true}) {
      const std::string name = "alpha3_" + std::to_string(std::lround(180 + alpha3 * 180 / M_PI)) +
                               "_less_180_wrist_" + (straight ? "straight" : "bent");
      all.push_back({name + "_narrow", narrow_arm(alpha3, 0.4, 2), straight});
      all.push_back({name + "_wide", narrow_arm(alpha3, 1.2, 0.8), straight});
    }
  }
  return all;
}

class RrpZyzFreeBase : public ::testing::TestWithParam<FreeBase> {};

TEST_P(RrpZyzFreeBase, FindsAPostureWithinTheLimitsFromAnySeedWithinThem) {
  SCOPED_TRACE("seed " + std::to_string(kFreeBaseSeed));
  std::mt19937_64 random{kFreeBaseSeed};
  const RobotModel& arm = *GetParam().arm;
  const auto solver = testing::solver_for(arm);
  const double theta2 = arm.joints()[1].theta, theta5 = arm.joints()[4].theta;
  for (int n = 0; n < kFreeBasePoses; ++n) {
    JointVector q = testing::random_joints(arm, random);
    q[1] = wrap_angle((n % 2 == 0 ? 0 : M_PI) - theta2);
    if (GetParam().wrist_straight) q[4] = -wrap_angle(theta5);
    if (!arm.within_limits(q)) continue;  // the straight wrist lies outside of joint 5's limits
    const JointVector seed = testing::random_joints(arm, random);
    IkBranches found;
    IkState state;
    const IkGoal goal = testing::goal_at(arm, q);
    const IkStatus status = solver->solve(goal, seed, found, state);
    ASSERT_EQ(status.code, IkStatus::Code::ok)
        << describe(status) << " for " << q.transpose() << " from " << seed.transpose();
    ASSERT_EQ(found.count, 4);
    for (const IkBranch& branch : found) {
      const auto error = residual(forward_kinematics(arm, branch.q), {}, goal.pose);
      ASSERT_LE(std::max(error.position_m, error.angle_rad), 2e-12) << branch.label;
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Arms, RrpZyzFreeBase, ::testing::ValuesIn(free_bases()),
                         [](const auto& one) { return one.param.name; });

TEST(RrpZyzFreeBases, KeepTheSeedsJointOneWhereTheLimitsAllowIt) {
  const auto arm = narrow_arm(0, 1, 2);
  const JointVector q =
      testing::joints({0.4, wrap_angle(-arm->joints()[1].theta), 0.2, 0.3, 0.5, 0.2});
  JointVector seed = q;
  seed[0] = 0.1;
  IkBranches found;
  IkState state;
  ASSERT_EQ(testing::solver_for(*arm)->solve(testing::goal_at(*arm, q), seed, found, state).code,
            IkStatus::Code::ok);
  EXPECT_NEAR(found.branch[0].q[0], 0.1, 1e-15);
}

}  // namespace
}  // namespace armature
