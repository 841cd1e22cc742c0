// SPDX-License-Identifier: Apache-2.0
// What is chosen is at least as good as anything on a dense scan, by costs worked out from joints
// and Jacobians.
#include "arm_angle_choice.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <functional>
#include <optional>
#include <string>

#include "armature/robot/kinematics/kinematics.hpp"
#include "test_arms.hpp"

namespace armature {
namespace {

struct Subject {
  std::string objective;
  std::string name;
  ModelPtr model;
  friend void PrintTo(const Subject& subject, std::ostream* out) {
    *out << subject.objective << "_" << subject.name;
  }
};

class ArmAngleChoices : public testing::TestWithParam<Subject> {
 protected:
  const RobotModel& model() const { return *GetParam().model; }

  double limit_cost(const JointVector& q) const {
    double sum = 0;
    for (int i = 0; i < 7; ++i) {
      const double half = 0.5 * (model().upper()[i] - model().lower()[i]);
      const double middle = 0.5 * (model().upper()[i] + model().lower()[i]);
      if (half >= M_PI) continue;
      const double u = wrap_angle(q[i] - middle) / half;
      sum += u * u / std::max(1 - u * u, 1e-9);
    }
    return sum;
  }
  double cost(const JointVector& q, double arm_angle, double wanted) const {
    const std::string& objective = GetParam().objective;
    const double from_wanted = wrap_angle(arm_angle - wanted);
    const double from_last = last_ ? from_wanted : 0;
    if (objective == "limits") return limit_cost(q);
    if (objective == "singularity") return -std::pow(manipulability(model(), q), 2);
    if (objective == "continuity") return std::abs(from_wanted);
    const double s = std::sin(arm_.canonical(1, q[1])), z = std::sin(arm_.canonical(5, q[5]));
    return limit_cost(q) + 0.02 * (1 / (s * s + 1e-3) + 1 / (z * z + 1e-3)) +
           0.1 * from_last * from_last;
  }
  const IkBranch& branch_at(double arm_angle, std::string_view label) {
    goal_.redundancy = arm_angle;
    IkState state;
    solver_->solve(goal_, seed_, scanned_, state);
    return *std::ranges::find(scanned_, label, &IkBranch::label);
  }
  /// A place that is better than the chosen one by more than rounding, on a scan of the branch's
  /// intervals or next to it.
  std::optional<double> better_than(const IkBranch& chosen, double wanted, int samples) {
    const double least = cost(chosen.q, chosen.redundancy, wanted);
    const double slack = 1e-10 * (1 + std::abs(least));
    const auto is_better = [&](double at) {
      const IkBranch& other = branch_at(at, chosen.label);
      return other.within_limits && cost(other.q, at, wanted) < least - slack;
    };
    for (const RedundancyInterval& interval : intervals_) {
      if (interval.label != chosen.label) continue;
      const double width = interval.upper - interval.lower;
      const int steps = 2 + static_cast<int>(samples * width / (2 * M_PI));
      for (int i = 0; i <= steps; ++i) {
        const double at = interval.lower + width * i / steps;
        if (is_better(at)) return at;
      }
      for (const double by : {1e-3, -1e-3, 1e-5, -1e-5}) {
        const double at = chosen.redundancy + by;
        if (at > interval.lower && at < interval.upper && is_better(at)) return at;
      }
    }
    return std::nullopt;
  }
  bool is_inside(const IkBranch& chosen) const {
    return std::ranges::any_of(intervals_, [&](const RedundancyInterval& interval) {
      return interval.label == chosen.label && chosen.redundancy >= interval.lower - 1e-9 &&
             chosen.redundancy <= interval.upper + 1e-9;
    });
  }
  struct Count {
    int branches = 0, missed = 0;
  };
  /// Asks for poses anywhere and at the limits, and shows `missed` what is better than what was
  /// chosen.
  Count scan(int poses, const std::function<void(const IkBranch&, double)>& missed) {
    Count count;
    for (int i = 0; i < poses && !HasFailure(); ++i) {
      const JointVector q =
          i % 3 == 0 ? joints_at_limits(model(), random_) : random_joints(model(), random_);
      goal_ = goal_at(model(), q);
      seed_ = random_joints(model(), random_);
      solver_->feasible_redundancy(goal_, seed_, intervals_);
      if (i % 2 == 1) last_ = std::uniform_real_distribution{-M_PI, M_PI}(random_);
      if (i % 2 == 0) last_.reset();
      const double wanted =
          kept_arm_angle(arm_, seed_, last_ ? *last_ : *solver_->redundancy_of(seed_),
                         srs_goal(arm_, goal_, seed_));
      IkBranches found;
      IkState state{last_};
      EXPECT_EQ(solver_->solve(goal_, seed_, found, state).code, IkStatus::Code::ok);
      EXPECT_EQ(found.count, 8);
      for (const IkBranch& branch : found) {
        const bool feasible = std::ranges::find(intervals_, branch.label,
                                                &RedundancyInterval::label) != intervals_.end();
        EXPECT_EQ(branch.within_limits, feasible) << branch.label << ", " << q.transpose();
        if (!feasible) continue;
        EXPECT_TRUE(is_inside(branch)) << branch.label << " at " << branch.redundancy;
        ++count.branches;
        if (const auto better = better_than(branch, wanted, 360)) {
          ++count.missed;
          missed(branch, *better);
        }
      }
    }
    return count;
  }

  SrsArm arm_ = srs_arm(model()).value();
  std::shared_ptr<const IkSolver> solver_ = solver_for(model(), GetParam().objective);
  std::mt19937_64 random_{909};
  IkGoal goal_;
  JointVector seed_;
  std::optional<double> last_;  // arm angle that is remembered
  IkBranches scanned_;
  RedundancyIntervals intervals_;
};

TEST_P(ArmAngleChoices, AreAsGoodAsADenseScan) {
  SCOPED_TRACE("seed 909");
  const Count count = scan(200, [&](const IkBranch& chosen, double better) {
    ADD_FAILURE() << chosen.label << " at " << chosen.redundancy << " instead of " << better
                  << ", pose of " << chosen.q.transpose();
  });
  EXPECT_GT(count.branches, 200);
}

/// Takes minutes: --gtest_also_run_disabled_tests --gtest_filter=*TenThousand*
TEST_P(ArmAngleChoices, DISABLED_MissAlmostNothingOfTenThousandPoses) {
  SCOPED_TRACE("seed 909");
  const Count count = scan(10000, [](const IkBranch&, double) {});
  std::printf("%s: %d of %d branches missed\n", testing::PrintToString(GetParam()).c_str(),
              count.missed, count.branches);
  EXPECT_LE(count.missed, count.branches / 1000);
}

std::vector<Subject> subjects() {
  std::vector<Subject> list;
  for (const char* objective : {"limits", "singularity", "continuity", "balanced"}) {
    list.push_back({objective, "med7", med7()});
    list.push_back({objective, "uneven_arm", uneven_arm()});
    list.push_back({objective, "narrow_arm", narrow_arm()});
  }
  return list;
}
INSTANTIATE_TEST_SUITE_P(Srs, ArmAngleChoices, testing::ValuesIn(subjects()),
                         testing::PrintToStringParamName());

/// To within 1e-8 rad: the slope changes its sign there.
TEST(ArmAngleChoice, IsTheMinimumToAHundredMillionthOfARadian) {
  SCOPED_TRACE("seed 911");
  std::mt19937_64 random{911};
  const ModelPtr model = med7();
  const SrsArm arm = srs_arm(*model).value();
  const ArmNumbers numbers = numbers_of(arm);
  const Aim aim{.objective = Objective::limits};
  int checked = 0;
  for (int i = 0; i < 20000; ++i) {
    const JointVector q =
        i % 2 == 0 ? joints_at_limits(*model, random) : random_joints(*model, random);
    const SrsGoal goal = srs_goal(arm, goal_at(*model, q), q);
    const FeasibleAngles feasible{numbers, goal, srs_kernel()};
    const auto chosen = best_arm_angles(numbers, goal, srs_kernel(), aim, q, feasible);
    for (std::size_t k = 0; k < 8; ++k) {
      const double at = chosen[k] - half_turns(kBranches[k].elbow);
      const auto table = std::make_unique<CostTable>();
      for (const double by : {-1e-8, 0.0, 1e-8}) table->place[table->count++] = at + by;
      srs_kernel().costs_all_round(numbers, goal, aim, *table);
      // Next to a limit rounding makes up the cost.
      if (feasible.bits(k) == 0 || !(table->value[k][1] < 100)) continue;
      EXPECT_LE(table->slope[k][0], 0) << q.transpose();
      EXPECT_GE(table->slope[k][2], 0) << q.transpose();
      ++checked;
    }
  }
  EXPECT_GT(checked, 50000);
}

TEST(ArmAngleChoice, TheLastArmAngleIsKeptBeforeTheSeeds) {
  const auto solver = solver_for(*med7(), "continuity");
  JointVector q(7), seed(7);
  q << 0.1, 0.9, 0.2, 1, -0.3, -0.8, 0.4;
  seed << 0.4, 0.9, -0.1, 1.2, 0, -0.5, 0;
  const IkGoal goal = goal_at(*med7(), q);
  IkBranches found;
  IkState fresh, told{.last_redundancy = 0.25};
  solver->solve(goal, seed, found, fresh);
  EXPECT_NEAR(found.branch[1].redundancy, *solver->redundancy_of(seed), 1e-15);
  solver->solve(goal, seed, found, told);
  EXPECT_EQ(found.branch[1].redundancy, 0.25);
}

/// The joints of the branch that is nearest to `q`, of the tool `by` [m] beside where `q` has it.
JointVector nearest_beside(const RobotModel& model, const IkSolver& solver, const JointVector& q,
                           const Eigen::Vector3d& by) {
  IkGoal goal = goal_at(model, q);
  goal.pose.position += by;
  IkBranches found;
  IkState state{.last_redundancy = solver.redundancy_of(q)};
  EXPECT_EQ(solver.solve(goal, q, found, state).code, IkStatus::Code::ok);
  return std::ranges::min_element(
             found, {}, [&](const IkBranch& branch) { return joint_distance(branch.q, q); })
      ->q;
}

TEST(ArmAngleChoice, AWristThatLeavesAxis1TakesTheElbowAlongWhicheverWayItGoes) {
  const ModelPtr model = without_limits(*med7());
  JointVector hanging(7);
  hanging << 0.3, 2.4, 0, 2 * (2.4 - M_PI), 0.1, 0.4, 0;  // the wrist below the shoulder
  for (const char* objective : {"continuity", "balanced"}) {
    const auto solver = solver_for(*model, objective);
    for (const JointVector& q : {JointVector{*med7()->home()}, hanging}) {
      const JointVector there = nearest_beside(*model, *solver, q, Eigen::Vector3d::Zero());
      for (int i = 0; i < 16; ++i) {
        const double azimuth = i * M_PI / 8;
        const Eigen::Vector3d by{1e-4 * std::cos(azimuth), 1e-4 * std::sin(azimuth), 0};
        EXPECT_LT(joint_distance(nearest_beside(*model, *solver, q, by), there), 0.01)
            << objective << " " << azimuth;
      }
    }
  }
}

TEST(ArmAngleChoice, AWristThatPassesAxis1NearlyTurnsNoJointFast) {
  const ModelPtr model = med7();
  const auto solver = solver_for(*model, "continuity");
  constexpr double kStep_m = 0.001, kBeside_m = 0.0003;
  JointVector q = nearest_beside(*model, *solver, *model->home(), {-0.15, kBeside_m, 0});
  double fastest = 0;
  for (int i = 0; i < 300; ++i) {
    const JointVector next = nearest_beside(*model, *solver, q, {kStep_m, 0, 0});
    fastest = std::max(fastest, joint_distance(next, q));
    q = next;
  }
  EXPECT_LT(fastest, 0.02) << "a millimetre is 2.5 mrad for an arm of 0.4 m";
}

TEST(ArmAngleChoice, OfAnArmWithoutLimitsStaysWhereItWas) {
  const ModelPtr model = without_limits(*med7());
  const auto solver = solver_for(*model, "limits");
  JointVector q(7);
  q << 0.1, 0.9, 0.2, 1, -0.3, -0.8, 0.4;
  IkBranches found;
  IkState state;
  solver->solve(goal_at(*model, q), q, found, state);
  for (const IkBranch& branch : found) {
    EXPECT_EQ(branch.redundancy, *solver->redundancy_of(q));
  }
  EXPECT_LE(joint_distance(found.branch[1].q, q), 1e-14);
}

}  // namespace
}  // namespace armature
