// SPDX-License-Identifier: Apache-2.0
// The kernel's arithmetic against the scalar forms and the joints, for all builds of it.
#include "arm_kernel.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <string>
#include <vector>

#include "arm_angle_choice.hpp"
#include "places.hpp"
#include "srs_branch.hpp"
#include "test_arms.hpp"

namespace armature {
namespace {

struct KernelSubject {
  std::string name;
  const SrsKernel* kernel;
  ModelPtr model;
  friend void PrintTo(const KernelSubject& subject, std::ostream* out) { *out << subject.name; }
};

class SrsKernelTest : public testing::TestWithParam<KernelSubject> {
 protected:
  const SrsKernel& kernel() const { return *GetParam().kernel; }
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
  /// A branch of the kernel's against the scalar form.
  void expect_branch(const SrsGoal& goal, const EightBranches& found, std::size_t lane,
                     std::size_t index, double arm_angle) const {
    const Branch& branch = kBranches[index];
    const ArmCircle circle = arm_circle(goal, static_cast<int>(branch.elbow));
    const ArmPosture posture = posture_at(circle, arm_angle);
    const IkBranch wanted =
        branch_of(arm_, solve_elbow(arm_, goal, circle, arm_angle), branch.flips, branch.label);
    const double sine = std::min(posture.shoulder.b.sin, posture.wrist.b.sin);
    EXPECT_EQ(found.in_line >> lane & 1, 0u);
    for (std::size_t i = 0; i < 7; ++i) {
      EXPECT_NEAR(wrap_angle(found.joint[i][lane] - wanted.q.data()[i]), 0, 4e-15 / sine)
          << branch.label << ", joint " << i;
      EXPECT_GE(found.joint[i][lane], -M_PI);
      EXPECT_LT(found.joint[i][lane], M_PI);
    }
    EXPECT_EQ((found.within_limits >> lane & 1) != 0, wanted.within_limits) << branch.label;
    EXPECT_EQ((found.singular >> lane & 1) != 0, wanted.singular) << branch.label;
    EXPECT_NEAR(found.position_m[lane], wanted.residual.position_m, 1e-14);
    EXPECT_NEAR(found.angle_rad[lane], wanted.residual.angle_rad, 1e-14);
  }

  /// The table at `places` against the branches one by one, up to a rounding of joints that turn no
  /// faster than `fastest`.
  void expect_costs(const SrsGoal& goal, const Aim& aim, const std::vector<double>& places,
                    double rounding, double fastest) const {
    CostTable table;
    std::ranges::copy(places, table.place);
    table.count = static_cast<int>(places.size());
    kernel().cost_all_round(numbers_, goal, aim, table);
    for (int branch = 0; branch < 8; ++branch) {
      for (std::size_t k = 0; k < places.size(); ++k) {
        const double at = wrap_angle(places[k] + half_turns(branch / 2 % 2));
        const EightPlaces place{.arm_angle = {at}, .branch = {branch}};
        double value[8], slope[8];
        kernel().cost_at(numbers_, goal, aim, place, 1, value, slope);
        if (value[0] > 1e4) continue;  // beyond the limits
        // A joint at a rounding less or more costs so much more where limits are near.
        const double steep = 1 + std::pow(value[0], 2);
        EXPECT_NEAR(table.value[branch][k], value[0], rounding * steep) << places[k];
        EXPECT_NEAR(table.slope[branch][k], slope[0],
                    rounding * steep * (fastest + std::abs(slope[0])))
            << places[k];
      }
    }
  }

  SrsArm arm_ = srs_arm(model()).value();
  ArmNumbers numbers_ = numbers_of(arm_);
  std::mt19937_64 random_{31};
};

TEST_P(SrsKernelTest, TurnsAllBranchesAsTheScalarFormDoes) {
  SCOPED_TRACE("seed 31");
  for (int i = 0; i < 3000 && !HasFailure(); ++i) {
    const SrsGoal goal = any_goal();
    const double arm_angle = any_angle();
    EightBranches found;
    kernel().turn_to(numbers_, goal, arm_angle, found);
    for (std::size_t k = 0; k < 8; ++k) expect_branch(goal, found, k, k, arm_angle);
  }
}

TEST_P(SrsKernelTest, TurnsEachBranchToAnArmAngleOfItsOwn) {
  SCOPED_TRACE("seed 31");
  for (int i = 0; i < 3000 && !HasFailure(); ++i) {
    const SrsGoal goal = any_goal();
    const EightPlaces at = any_places();
    EightBranches found;
    kernel().turn_each(numbers_, goal, at, found);
    for (std::size_t k = 0; k < 8; ++k) {
      expect_branch(goal, found, k, static_cast<std::size_t>(at.branch[k]), at.arm_angle[k]);
    }
  }
}

TEST_P(SrsKernelTest, TellsWhatIsInLine) {
  SCOPED_TRACE("seed 31");
  for (int i = 0; i < 1000; ++i) {
    Angles t = angles_of(arm_, random_joints(model(), random_));
    t[i % 2 == 0 ? 1 : 5] = 0;
    const JointVector q = joints_of(arm_, t);
    const SrsGoal goal = srs_goal(arm_, goal_at(model(), q), q);
    EXPECT_TRUE(i % 2 == 0 ? goal.shoulder_in_line : goal.wrist_in_line);
    const double arm_angle = arm_angle_of(arm_, t);
    EightBranches found;
    kernel().turn_to(numbers_, goal, arm_angle, found);
    const std::size_t elbow = t[3] >= 0 ? 0 : 1;
    for (std::size_t k = 0; k < 8; ++k) {
      if (kBranches[k].elbow == elbow) {
        EXPECT_EQ(found.in_line >> k & 1, 1u) << k;
      }
    }
  }
}

/// Elbow 1 at an arm angle is elbow 0 half a turn on: one table has both. In single
/// precision: where joints are fast or near limits its rounding counts for more.
TEST_P(SrsKernelTest, CostsAllRoundAreThoseOfTheBranches) {
  SCOPED_TRACE("seed 31");
  for (int i = 0; i < 500 && !HasFailure(); ++i) {
    const SrsGoal goal = any_goal();
    const Aim aim{.objective = static_cast<Objective>(i % 4), .remembers = i % 3 == 0, .last = 0.4};
    if (aim.objective == Objective::continuity) continue;
    std::vector<double> places(9);
    for (std::size_t k = 0; k < places.size(); ++k) places[k] = -3 + 0.7 * static_cast<double>(k);
    expect_costs(goal, aim, places, 1e-6, 1);
  }
}

/// Where a ball is so near to in line that its outer joints sweep through half a turn within some
/// 1e-4 rad of the arm angle.
TEST_P(SrsKernelTest, CostsAllRoundSeeTheTurnNextToInLine) {
  SCOPED_TRACE("seed 31");
  const Aim aim{.objective = Objective::limits};
  for (int i = 0; i < 500 && !HasFailure(); ++i) {
    Angles t = angles_of(arm_, random_joints(model(), random_));
    t[i % 2 == 0 ? 1 : 5] = i % 4 < 2 ? 1e-4 : -1e-4;
    const JointVector q = joints_of(arm_, t);
    const SrsGoal goal = srs_goal(arm_, goal_at(model(), q), q);
    const double in_line = arm_angle_of(arm_, t) - half_turns(t[3] < 0 ? 1 : 0);
    std::vector<double> places;
    for (const double away : {0.0, 1e-5, 4e-5, 1e-4, 3e-4}) {
      for (const double side : {-1.0, 1.0}) places.push_back(in_line + side * away);
    }
    expect_costs(goal, aim, places, 1e-6, 1e4);
  }
}

TEST_P(SrsKernelTest, TheTableIsAtPiWhatItIsAtMinusPi) {
  SCOPED_TRACE("seed 31");
  for (int i = 0; i < 500; ++i) {
    const Aim aim{.objective = i % 2 == 0 ? Objective::limits : Objective::singularity};
    const SrsGoal goal = any_goal();
    CostTable table;
    set_places(goal, aim, table);
    kernel().cost_all_round(numbers_, goal, aim, table);
    for (int branch = 0; branch < 8; ++branch) {
      EXPECT_EQ(table.value[branch][0], table.value[branch][table.sorted - 1]);
      EXPECT_EQ(table.slope[branch][0], table.slope[branch][table.sorted - 1]);
    }
  }
}

/// To within 1e-8 rad: the slope changes its sign there.
TEST_P(SrsKernelTest, MinimaAreWhereTheSlopeChangesItsSign) {
  SCOPED_TRACE("seed 31");
  int checked = 0;
  for (int i = 0; i < 20000 && !HasFailure(); ++i) {
    const SrsGoal goal = any_goal();
    const Aim aim{.objective = i % 2 == 0 ? Objective::limits : Objective::singularity};
    EightPlaces from = any_places(), to = from, outer = from;
    for (double& at : to.arm_angle) at += 0.2;
    for (double& at : outer.arm_angle) at += random_() % 2 == 0 ? 0.4 : -0.2;
    EightValleys valleys;
    const auto set_nodes = [&](const EightPlaces& at, EightNodes& nodes) {
      kernel().cost_at(numbers_, goal, aim, at, 8, nodes.value, nodes.slope);
      std::copy_n(at.arm_angle, 8, nodes.at);
    };
    set_nodes(from, valleys.left);
    set_nodes(to, valleys.right);
    set_nodes(outer, valleys.outer);
    valleys.outer.at[i % 8] = std::numeric_limits<double>::quiet_NaN();
    std::copy_n(from.branch, 8, valleys.branch);
    std::copy_n(from.arm_angle, 8, valleys.lower);
    std::copy_n(to.arm_angle, 8, valleys.upper);
    EightMinima found;
    kernel().find_minima(numbers_, goal, aim, valleys, 8, found);
    EightPlaces before = from, behind = from;
    for (int k = 0; k < 8; ++k) {
      before.arm_angle[k] = found.at[k] - 1e-8;
      behind.arm_angle[k] = found.at[k] + 1e-8;
    }
    double value[8], fall[8], rise[8];
    kernel().cost_at(numbers_, goal, aim, before, 8, value, fall);
    kernel().cost_at(numbers_, goal, aim, behind, 8, value, rise);
    for (int k = 0; k < 8; ++k) {
      const bool valley = valleys.left.slope[k] < 0 && valleys.right.slope[k] > 0 &&
                          valleys.left.value[k] < 100 && valleys.right.value[k] < 100;
      if (!valley) continue;
      EXPECT_LE(fall[k], 0) << found.at[k];
      EXPECT_GE(rise[k], 0) << found.at[k];
      EXPECT_NEAR(found.value[k], value[k], 1e-10 * (1 + std::abs(value[k])));
      ++checked;
    }
  }
  EXPECT_GT(checked, 1000);
}

std::vector<KernelSubject> kernel_subjects() {
  std::vector<KernelSubject> list;
  for (const auto& [name, model] : {std::pair{std::string{"med7"}, med7()},
                                    std::pair{std::string{"uneven_arm"}, uneven_arm()}}) {
    const SrsKernels kernels = srs_kernels();
    for (int i = 0; i < kernels.count; ++i) {
      list.push_back(
          {name + std::array{"_portable", "_avx2", "_avx512"}[static_cast<std::size_t>(i)],
           kernels.kernel[i], model});
    }
  }
  return list;
}
INSTANTIATE_TEST_SUITE_P(Srs, SrsKernelTest, testing::ValuesIn(kernel_subjects()),
                         testing::PrintToStringParamName());

void expect_same(const SrsKernel& first, const SrsKernel& second) {
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
      const SrsKernel& kernel = build == 0 ? first : second;
      const FeasibleAngles feasible{numbers, goal, kernel};
      for (std::size_t k = 0; k < 8; ++k) feasible.of_elbow0(kBranches[k], spans[build][k]);
      ArmAngleChoice{numbers, goal, kernel, aim, q}.choose(spans[build], arm_angle[build]);
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

TEST(SrsKernel, AllBuildsFindTheSameIntervalsAndArmAngles) {
  const SrsKernels kernels = srs_kernels();
  if (kernels.count == 1) GTEST_SKIP() << "this processor has one only";
  for (int i = 1; i < kernels.count; ++i) {
    expect_same(portable_srs_kernel(), *kernels.kernel[i]);
  }
}

}  // namespace
}  // namespace armature
