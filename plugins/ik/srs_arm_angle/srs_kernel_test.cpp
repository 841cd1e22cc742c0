// SPDX-License-Identifier: Apache-2.0
// The arithmetic in lanes, of all builds of it that this processor can run: costs and their slopes,
// and that all find the same.
#include "srs_kernel.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <memory>
#include <string>
#include <vector>

#include "arm_angle_choice.hpp"
#include "test_arms.hpp"

namespace armature {
namespace {

struct KernelSubject {
  std::string name;
  const SrsKernel* kernel;
  friend void PrintTo(const KernelSubject& subject, std::ostream* out) { *out << subject.name; }
};
std::vector<KernelSubject> kernel_subjects() {
  std::vector<KernelSubject> list{{"portable", &portable::srs_kernel()}};
  if (&srs_kernel() != list[0].kernel) list.push_back({"fastest", &srs_kernel()});
  return list;
}

class SrsKernelTest : public testing::TestWithParam<KernelSubject> {
 protected:
  SrsGoal any_goal() {
    const JointVector q = random_joints(*model_, random_);
    return srs_goal(arm_, goal_at(*model_, q), random_joints(*model_, random_));
  }
  /// Of a branch at an arm angle of elbow 0.
  Node cost_at(const SrsGoal& goal, const Aim& aim, std::size_t branch, double at) const {
    const auto table = std::make_unique<CostTable>();
    table->place[table->count++] = at;
    GetParam().kernel->costs_all_round(numbers_, goal, aim, *table);
    return table->node(branch, 0);
  }

  ModelPtr model_ = uneven_arm();
  SrsArm arm_ = srs_arm(*model_).value();
  ArmNumbers numbers_ = numbers_of(arm_);
  std::mt19937_64 random_{31};
};

TEST_P(SrsKernelTest, SlopesAreThoseOfTheCosts) {
  SCOPED_TRACE("seed 31");
  std::uniform_real_distribution<double> angle{-M_PI, M_PI};
  int checked = 0;
  for (int i = 0; i < 2000; ++i) {
    const SrsGoal goal = any_goal();
    const double at = angle(random_);
    const Branch& branch = kBranches[random_() % 8];
    const int elbow = static_cast<int>(branch.elbow);
    TwoArms arms;
    GetParam().kernel->turn(numbers_, goal, {{at, at}, {0, 0}}, arms);
    const double s = std::sin(arm_.canonical(1, arms.joint[0][1][0])),
                 z = std::sin(arm_.canonical(5, arms.joint[0][1][2]));
    if (std::min(s * s, z * z) < 0.01) continue;
    constexpr double kStep = 1e-6;
    for (const Objective objective :
         {Objective::limits, Objective::singularity, Objective::balanced}) {
      const Aim aim{.objective = objective, .remembers = true, .last = at - 0.3 + M_PI * elbow};
      const auto which = static_cast<std::size_t>(&branch - kBranches.data());
      const Node here = cost_at(goal, aim, which, at);
      const Node next = cost_at(goal, aim, which, at + kStep);
      const Node last = cost_at(goal, aim, which, at - kStep);
      if (!(here.value < 20)) continue;  // beyond the limits
      const double slope = (next.value - last.value) / (2 * kStep);
      EXPECT_NEAR(here.slope, slope, 1e-4 * (1 + std::abs(slope)));
      ++checked;
    }
  }
  EXPECT_GT(checked, 1000);
}

/// And valleys are where slopes change their sign.
TEST_P(SrsKernelTest, TheTableHasTheCostsOfTheBranches) {
  SCOPED_TRACE("seed 31");
  for (int i = 0; i < 500 && !HasFailure(); ++i) {
    const SrsGoal goal = any_goal();
    const Aim aim{.objective = static_cast<Objective>(i % 4), .remembers = i % 3 == 0, .last = 0.4};
    if (aim.objective == Objective::continuity) continue;
    const auto table = std::make_unique<CostTable>();
    for (int k = 0; k < 71; ++k) table->place[table->count++] = -3 + 0.08 * k;
    GetParam().kernel->costs_all_round(numbers_, goal, aim, *table);
    for (std::size_t branch = 0; branch < 8; ++branch) {
      for (int k = 0; k + 1 < table->count; ++k) {
        const Node left = table->node(branch, k), right = table->node(branch, k + 1);
        const Node wanted = cost_at(goal, aim, branch, left.at);
        EXPECT_NEAR(left.value, wanted.value, 1e-14 * std::abs(wanted.value));
        EXPECT_NEAR(left.slope, wanted.slope, 1e-13 * (1 + std::abs(wanted.slope)));
        const bool valley = (table->valley[branch][k / 64] >> (k % 64) & 1) != 0;
        const bool seen = (left.slope < 0 && (right.slope >= 0 || right.value > left.value)) ||
                          (right.slope > 0 && (left.slope <= 0 || left.value > right.value));
        EXPECT_EQ(valley, seen) << branch << ", " << k;
      }
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Srs, SrsKernelTest, testing::ValuesIn(kernel_subjects()),
                         testing::PrintToStringParamName());

TEST(SrsKernel, AllBuildsFindTheSameIntervalsAndArmAngles) {
  const SrsKernel* builds[]{&portable::srs_kernel(), &srs_kernel()};
  if (builds[0] == builds[1]) GTEST_SKIP() << "this processor has one only";
  SCOPED_TRACE("seed 32");
  std::mt19937_64 random{32};
  const SrsArm arm = srs_arm(*med7()).value();
  const ArmNumbers numbers = numbers_of(arm);
  const Aim aim{.objective = Objective::limits};
  for (int i = 0; i < 2000 && !testing::Test::HasFailure(); ++i) {
    const JointVector q = random_joints(*med7(), random);
    const SrsGoal goal = srs_goal(arm, goal_at(*med7(), q), q);
    std::array<std::array<Spans, 8>, 2> spans;
    std::array<std::array<double, 8>, 2> arm_angle;
    for (std::size_t build = 0; build < 2; ++build) {
      const FeasibleAngles feasible{numbers, goal, *builds[build]};
      for (std::size_t k = 0; k < 8; ++k) spans[build][k] = feasible.of(k);
      arm_angle[build] = best_arm_angles(numbers, goal, *builds[build], aim, q, feasible);
    }
    for (std::size_t k = 0; k < 8; ++k) {
      ASSERT_EQ(spans[0][k].count, spans[1][k].count) << q.transpose();
      for (int n = 0; n < spans[0][k].count; ++n) {
        EXPECT_NEAR(spans[0][k].begin()[n].lower, spans[1][k].begin()[n].lower, 1e-9);
        EXPECT_NEAR(spans[0][k].begin()[n].upper, spans[1][k].begin()[n].upper, 1e-9);
      }
      EXPECT_NEAR(arm_angle[0][k], arm_angle[1][k], 1e-8) << q.transpose();
    }
  }
}

/// Two builds turn arms alike; that they are right is said by the forward kinematics of the other
/// tests.
TEST(SrsKernel, AllBuildsTurnArmsAlike) {
  SCOPED_TRACE("seed 33");
  std::mt19937_64 random{33};
  const SrsArm arm = srs_arm(*uneven_arm()).value();
  const ArmNumbers numbers = numbers_of(arm);
  std::uniform_real_distribution<double> angle{-M_PI, M_PI};
  for (int i = 0; i < 3000; ++i) {
    const JointVector q = random_joints(*uneven_arm(), random);
    const SrsGoal goal = srs_goal(arm, goal_at(*uneven_arm(), q), q);
    const TwoPlaces at{{angle(random), angle(random)}, {i % 2, i / 2 % 2}};
    TwoArms one, other;
    portable::srs_kernel().turn(numbers, goal, at, one);
    srs_kernel().turn(numbers, goal, at, other);
    EXPECT_EQ(one.within_limits[0], other.within_limits[0]);
    EXPECT_EQ(one.within_limits[1], other.within_limits[1]);
    EXPECT_EQ(one.singular, other.singular);
    EXPECT_EQ(one.in_line, other.in_line);
    for (std::size_t lane = 0; lane < 4; ++lane) {
      const double sine =
          std::abs(std::sin(arm.canonical(lane < 2 ? 1 : 5, one.joint[0][1][lane])));
      for (std::size_t k = 0; k < 6; ++k) {
        const double a = one.joint[k / 3][k % 3][lane], b = other.joint[k / 3][k % 3][lane];
        EXPECT_NEAR(wrap_angle(a - b), 0, 4e-15 / sine);
        EXPECT_GE(b, -M_PI);
        EXPECT_LT(b, M_PI);
      }
    }
  }
}

}  // namespace
}  // namespace armature
