// SPDX-License-Identifier: Apache-2.0
// The builds of the kernel for several processors; the laws of the kind ask the one that this
// processor runs.
#include "arm_kernel.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "arm_angle_choice.hpp"
#include "srs_goal.hpp"
#include "test_arms.hpp"

namespace armature::ik::srs_arm_angle {
namespace {

struct KernelSubject {
  std::string name;
  const Kernel* kernel;
  ModelPtr model;
  friend void PrintTo(const KernelSubject& subject, std::ostream* out) { *out << subject.name; }
};

class SrsKernel : public testing::TestWithParam<KernelSubject> {
 protected:
  const Kernel& kernel() const { return *GetParam().kernel; }
  const RobotModel& model() const { return *GetParam().model; }

  SrsGoal any_goal() {
    const JointVector q = random_joints(model(), random_);
    return srs_goal(arm_, goal_at(model(), q), random_joints(model(), random_));
  }
  double any_angle() { return std::uniform_real_distribution{-M_PI, M_PI}(random_); }
  EightPlaces any_places() {
    EightPlaces at;
    for (double& angle : at.arm_angle) angle = any_angle();
    for (int& branch : at.branch) branch = static_cast<int>(random_() % 8);
    return at;
  }
  Node cost_at(const SrsGoal& goal, const Aim& aim, int branch, double at) const {
    Node node{branch, at, 0, 0};
    kernel().costs(arm_, goal, aim, 1, &node);
    return node;
  }

  SrsArm arm_ = srs_arm(model()).value();
  std::mt19937_64 random_{31};
};

/// Of a rounding, of joints that turn 1 / sin b as fast as the arm angle.
TEST_P(SrsKernel, AnswersAsTheOneForEveryProcessorDoes) {
  SCOPED_TRACE("seed 31");
  for (int i = 0; i < 3000 && !HasFailure(); ++i) {
    const SrsGoal goal = any_goal();
    const EightPlaces at = any_places();
    EightBranches found, wanted;
    kernel().solve_each(arm_, goal, at, found);
    portable_kernel().solve_each(arm_, goal, at, wanted);
    for (std::size_t k = 0; k < 8; ++k) {
      const double sine = std::min(std::abs(std::sin(arm_.canonical(1, wanted.joint[1][k]))),
                                   std::abs(std::sin(arm_.canonical(5, wanted.joint[5][k]))));
      for (std::size_t joint = 0; joint < 7; ++joint) {
        EXPECT_NEAR(wrap_angle(found.joint[joint][k] - wanted.joint[joint][k]), 0, 4e-15 / sine);
        EXPECT_GE(found.joint[joint][k], -M_PI);
        EXPECT_LT(found.joint[joint][k], M_PI);
      }
      EXPECT_LE(found.position_m[k], 1e-14);
      EXPECT_LE(found.angle_rad[k], 1e-14);
    }
    EXPECT_EQ(found.within_limits, wanted.within_limits);
    EXPECT_EQ(found.singular, wanted.singular);
    EXPECT_EQ(found.collinear_shoulder | found.collinear_wrist, 0U);
  }
}

TEST_P(SrsKernel, AnswersAllBranchesAtOneArmAngleAsEachByItself) {
  SCOPED_TRACE("seed 31");
  for (int i = 0; i < 3000 && !HasFailure(); ++i) {
    const SrsGoal goal = any_goal();
    EightPlaces at{.arm_angle = {}, .branch = {0, 1, 2, 3, 4, 5, 6, 7}};
    std::fill_n(at.arm_angle, 8, any_angle());
    EightBranches all, each;
    kernel().solve(arm_, goal, at.arm_angle[0], all);
    kernel().solve_each(arm_, goal, at, each);
    for (std::size_t joint = 0; joint < 7; ++joint) {
      for (std::size_t k = 0; k < 8; ++k) {
        EXPECT_NEAR(wrap_angle(all.joint[joint][k] - each.joint[joint][k]), 0, 1e-12);
      }
    }
    EXPECT_EQ(all.within_limits, each.within_limits);
    EXPECT_EQ(all.singular, each.singular);
  }
}

TEST_P(SrsKernel, TellsWhichAxesAreCollinear) {
  SCOPED_TRACE("seed 31");
  for (int i = 0; i < 1000; ++i) {
    const bool is_shoulder = i % 2 == 0;
    Angles t = angles_of(arm_, random_joints(model(), random_));
    t[is_shoulder ? 1 : 5] = 0;
    const JointVector q = joints_of(arm_, t);
    const SrsGoal goal = srs_goal(arm_, goal_at(model(), q), q);
    EXPECT_TRUE((is_shoulder ? goal.shoulder : goal.wrist).collinear);
    EightBranches found;
    kernel().solve(arm_, goal, arm_angle_of(arm_, q), found);
    const unsigned wanted = t[3] >= 0 ? 0xFF & ~kOfElbow1 : kOfElbow1;
    EXPECT_EQ((is_shoulder ? found.collinear_shoulder : found.collinear_wrist) & wanted, wanted);
  }
}

/// Elbow 1 at an arm angle is elbow 0 half a turn on: one table has both. Next to collinear axes
/// joints sweep through half a turn within some 1e-4 rad.
TEST_P(SrsKernel, CostsAllRoundAreThoseOfTheBranches) {
  SCOPED_TRACE("seed 31");
  for (int i = 0; i < 500 && !HasFailure(); ++i) {
    Angles t = angles_of(arm_, random_joints(model(), random_));
    if (i % 2 == 0) t[i % 4 == 0 ? 1 : 5] = 1e-4;
    const JointVector q = joints_of(arm_, t);
    const SrsGoal goal = srs_goal(arm_, goal_at(model(), q), q);
    const Aim aim{.objective = static_cast<Objective>(i % 4), .remembers = i % 3 == 0, .last = 0.4};
    if (aim.objective == Objective::continuity) continue;
    CostTable table;
    set_places(goal, aim, table);
    kernel().costs_all_round(arm_, goal, aim, table);
    for (int branch = 0; branch < 8; ++branch) {
      EXPECT_EQ(table.value[branch][0], table.value[branch][table.count - 1]);
      EXPECT_EQ(table.slope[branch][0], table.slope[branch][table.count - 1]);
      for (int k = 0; k < table.count; ++k) {
        const double half_turn = (kOfElbow1 >> branch & 1) != 0 ? M_PI : 0;
        const Node one = cost_at(goal, aim, branch, wrap_angle(table.place[k] + half_turn));
        if (one.value > 1e4) continue;  // beyond the limits
        const double rounding = 1e-9 * (1 + one.value * one.value);
        EXPECT_NEAR(table.value[branch][k], one.value, rounding);
        EXPECT_NEAR(table.slope[branch][k], one.slope, rounding * (1e4 + std::abs(one.slope)));
      }
    }
  }
}

TEST_P(SrsKernel, MinimaAreWhereTheSlopeChangesItsSignToTheHundredMillionthOfARadian) {
  SCOPED_TRACE("seed 31");
  int checked = 0;
  for (int i = 0; i < 100000 && !HasFailure(); ++i) {
    const SrsGoal goal = any_goal();
    const Aim aim{.objective = i % 2 == 0 ? Objective::limits : Objective::singularity};
    const int branch = i % 8;
    const double at = any_angle();
    const Valley valley{cost_at(goal, aim, branch, at), cost_at(goal, aim, branch, at + 0.2)};
    if (valley.left.slope >= 0 || valley.right.slope <= 0) continue;
    if (valley.left.value >= 100 || valley.right.value >= 100) continue;
    Node found;
    kernel().minima(arm_, goal, aim, 1, &valley, &found);
    EXPECT_LE(cost_at(goal, aim, branch, found.at - 1e-8).slope, 0) << found.at;
    EXPECT_GE(cost_at(goal, aim, branch, found.at + 1e-8).slope, 0) << found.at;
    EXPECT_NEAR(found.value, cost_at(goal, aim, branch, found.at).value,
                1e-10 * (1 + std::abs(found.value)));
    ++checked;
  }
  EXPECT_GT(checked, 1000);
}

std::vector<KernelSubject> kernel_subjects() {
  std::vector<KernelSubject> list;
  for (const auto& [name, model] : {std::pair{std::string{"med7"}, med7()},
                                    std::pair{std::string{"uneven_arm"}, uneven_arm()}}) {
    list.push_back({name + "_portable", &portable_kernel(), model});
    if (has_avx2()) list.push_back({name + "_fastest", &srs_arm_angle::kernel(), model});
  }
  return list;
}
INSTANTIATE_TEST_SUITE_P(Srs, SrsKernel, testing::ValuesIn(kernel_subjects()),
                         testing::PrintToStringParamName());

}  // namespace
}  // namespace armature::ik::srs_arm_angle
