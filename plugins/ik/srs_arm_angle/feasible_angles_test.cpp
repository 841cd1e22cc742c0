// SPDX-License-Identifier: Apache-2.0
// The intervals of the arm angle against joints computed at single arm angles.
#include "feasible_angles.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>

#include "test_arms.hpp"

namespace armature {
namespace {

constexpr double kNear = 1e-7;  // [rad] nearer to an end, rounding may decide

class FeasibleAnglesTest : public testing::TestWithParam<ArmSubject> {
 protected:
  using Posture = std::function<JointVector()>;

  /// Asks for the intervals of the pose of `q`.
  void ask(const JointVector& q) {
    goal_ = goal_at(model(), q);
    seed_ = q;
    ASSERT_TRUE(solver_->feasible_redundancy(goal_, seed_, found_));
    ASSERT_LT(found_.count, RedundancyIntervals::kCapacity);
  }
  /// The eight branches at one arm angle.
  const IkBranches& at(double arm_angle) {
    goal_.redundancy = arm_angle;
    IkState state;
    solver_->solve(goal_, seed_, branches_, state);
    return branches_;
  }
  const IkBranch& branch_at(double arm_angle, std::string_view label) {
    return *std::ranges::find(at(arm_angle), label, &IkBranch::label);
  }
  bool is_near_an_end(std::string_view label, double arm_angle) const {
    return std::ranges::any_of(found_, [&](const RedundancyInterval& interval) {
      const double nearest = std::min(std::abs(wrap_angle(interval.lower - arm_angle)),
                                      std::abs(wrap_angle(interval.upper - arm_angle)));
      return interval.label == label && nearest < kNear;
    });
  }
  bool is_inside(std::string_view label, double arm_angle) const {
    return std::ranges::any_of(found_, [&](const RedundancyInterval& interval) {
      return interval.label == label && interval.lower <= arm_angle && arm_angle <= interval.upper;
    });
  }

  /// At `samples` arm angles all round, a branch keeps its limits inside its intervals and nowhere
  /// else.
  void expect_agreement_all_round(int samples) {
    const double shift = any(0, 1);
    for (int i = 0; i < samples; ++i) {
      const double arm_angle = -M_PI + 2 * M_PI * (i + shift) / samples;
      for (const IkBranch& branch : at(arm_angle)) {
        if (is_near_an_end(branch.label, arm_angle)) continue;
        ASSERT_EQ(branch.within_limits, is_inside(branch.label, arm_angle))
            << branch.label << " at " << arm_angle << ", pose of " << seed_.transpose();
      }
    }
  }
  /// What rounding leaves of joints next to the poles of shoulder and wrist [rad].
  double rounding_at(const JointVector& q) const {
    const SrsArm arm = srs_arm(model()).value();
    const double sine = std::min(std::abs(std::sin(arm.canonical(1, q[1]))),
                                 std::abs(std::sin(arm.canonical(5, q[5]))));
    return 1e-14 / std::max(sine, 1e-14) + 1e-9;
  }
  /// However narrow an interval is, its inside keeps the limits.
  void expect_insides_to_keep_the_limits() {
    for (const RedundancyInterval& interval : found_) {
      ASSERT_LE(-M_PI, interval.lower);
      ASSERT_LE(interval.lower, interval.upper);
      ASSERT_LE(interval.upper, M_PI);
      const double width = interval.upper - interval.lower;
      for (const double part : {1e-3, 0.3, 0.5, 0.8, 0.999}) {
        const IkBranch& branch = branch_at(interval.lower + part * width, interval.label);
        EXPECT_LE(beyond_limits(branch.q), rounding_at(branch.q))
            << interval.label << " " << interval.lower << " + " << part << " * " << width
            << ", pose of " << seed_.transpose();
      }
    }
  }
  double beyond_limits(const JointVector& q) const {
    JointVector turned = q;
    unwind(model(), q, turned);
    return std::max((turned - model().upper()).maxCoeff(), (model().lower() - turned).maxCoeff());
  }
  double from_limits(const JointVector& q) const {
    double least = 10;
    for (int i = 0; i < 7; ++i) {
      for (const double end : {model().lower()[i], model().upper()[i]}) {
        least = std::min(least, std::abs(wrap_angle(q[i] - end)));
      }
    }
    return least;
  }
  /// Where an interval ends, a joint is at a limit (or joints jump, both axes of a ball in line),
  /// but for the place where the circle is cut.
  void expect_ends_at_limits() {
    for (const RedundancyInterval& interval : found_) {
      for (const double end : {interval.lower, interval.upper}) {
        if (std::abs(end) == M_PI) continue;
        const JointVector q = branch_at(end, interval.label).q;
        if (rounding_at(q) > 1e-5) continue;  // in line: the turns are shared out or jump
        EXPECT_LE(from_limits(q), rounding_at(q))
            << interval.label << " ends at " << end << ", pose of " << seed_.transpose();
      }
    }
  }
  void expect_right_intervals(int poses, int samples, const Posture& posture) {
    SCOPED_TRACE("seed 424242");
    for (int i = 0; i < poses; ++i) {
      ask(posture());
      expect_agreement_all_round(samples);
      expect_insides_to_keep_the_limits();
      expect_ends_at_limits();
      if (HasFailure()) return;
    }
  }

  double any(double lower, double upper) {
    return std::uniform_real_distribution{lower, upper}(random_);
  }
  const RobotModel& model() const { return *model_; }

  ModelPtr model_ = GetParam().model;
  std::shared_ptr<const IkSolver> solver_ = solver_for(model());
  std::mt19937_64 random_{424242};
  IkGoal goal_;
  JointVector seed_;
  RedundancyIntervals found_;
  IkBranches branches_;
};

TEST_P(FeasibleAnglesTest, AreThoseAtWhichTheLimitsAreKept) {
  expect_right_intervals(300, 720, [this] { return random_joints(model(), random_); });
}

TEST_P(FeasibleAnglesTest, OfPosturesAtTheLimitsContainThePostureItself) {
  SCOPED_TRACE("seed 424242");
  for (int i = 0; i < 2000; ++i) {
    const JointVector q = joints_at_limits(model(), random_);
    ask(q);
    const double arm_angle = *solver_->redundancy_of(q);
    double nearest = 10;
    for (const RedundancyInterval& interval : found_) {
      const double inside = std::clamp(arm_angle, interval.lower, interval.upper);
      nearest = std::min({nearest, std::abs(wrap_angle(inside - arm_angle)),
                          std::abs(wrap_angle(interval.lower - arm_angle)),
                          std::abs(wrap_angle(interval.upper - arm_angle))});
    }
    EXPECT_LE(nearest, 1e-7) << q.transpose();
    goal_.redundancy.reset();
    IkState state;
    EXPECT_EQ(solver_->solve(goal_, random_joints(model(), random_), branches_, state).code,
              IkStatus::Code::ok)
        << q.transpose();
  }
  expect_right_intervals(100, 720, [this] { return joints_at_limits(model(), random_); });
}

TEST_P(FeasibleAnglesTest, AreRightNextToEverySingularSet) {
  const SrsArm arm = srs_arm(model()).value();
  int turn = 0;
  expect_right_intervals(400, 360, [&] {
    constexpr std::array<double, 4> kOffsets{0, 1e-9, 1e-7, 1e-4};
    Angles t = angles_of(arm, random_joints(model(), random_));
    const int which = turn++;
    const double by = kOffsets[static_cast<std::size_t>(which % 4)];
    if (which / 4 % 5 == 0) t[1] = by;
    if (which / 4 % 5 == 1) t[5] = by;
    if (which / 4 % 5 == 2) t[3] = by;
    if (which / 4 % 5 == 3) t[1] = t[3] = t[5] = by;
    if (which / 4 % 5 == 4) t[1] = -0.5 * t[3], t[2] = by;  // the wrist over the base
    return joints_of(arm, t);
  });
}

INSTANTIATE_TEST_SUITE_P(Srs, FeasibleAnglesTest,
                         testing::Values(ArmSubject{"med7", med7()},
                                         ArmSubject{"narrow_arm", narrow_arm()},
                                         ArmSubject{"uneven_arm", uneven_arm()}),
                         testing::PrintToStringParamName());

TEST(FeasibleRedundancy, OfAGoalThatIsOutOfReachOrBadIsNotTold) {
  const auto solver = solver_for(*med7());
  const JointVector q = JointVector::Zero(7);
  RedundancyIntervals found;
  IkGoal goal = goal_at(*med7(), q);
  EXPECT_TRUE(solver->feasible_redundancy(goal, q, found));
  EXPECT_GT(found.count, 0);
  goal.pose.position.z() += 1e-9;
  EXPECT_FALSE(solver->feasible_redundancy(goal, q, found));
  EXPECT_EQ(found.count, 0);
  EXPECT_FALSE(solver->feasible_redundancy(goal, JointVector::Zero(6), found));
}

TEST(FeasibleRedundancy, OfAnArmWithoutLimitsIsTheWholeTurnOfEveryBranch) {
  const ModelPtr model = without_limits(*med7());
  const auto solver = solver_for(*model);
  RedundancyIntervals found;
  const JointVector q = med7()->home()->head(7);
  EXPECT_TRUE(solver->feasible_redundancy(goal_at(*model, q), q, found));
  ASSERT_EQ(found.count, 8);
  for (const RedundancyInterval& interval : found) {
    EXPECT_EQ(interval.lower, -M_PI);
    EXPECT_EQ(interval.upper, M_PI);
  }
}

TEST(FeasibleRedundancy, OfAnArmWithoutAFeasiblePostureIsNone) {
  const ModelPtr model = narrow_arm();
  const auto solver = solver_for(*model);
  JointVector q = JointVector::Zero(7);
  q[3] = 2;  // joint 4 ends at 110 degrees
  RedundancyIntervals found;
  EXPECT_TRUE(solver->feasible_redundancy(goal_at(*model, q), q, found));
  EXPECT_EQ(found.count, 0);
}

TEST(FeasibleRedundancy, AJointThatIsLockedLeavesPoints) {
  auto joints = med7()->joints();
  joints[0].lower = joints[0].upper = 0.3;
  const ModelPtr model = with_joints(*med7(), joints);
  const auto solver = solver_for(*model);
  SCOPED_TRACE("seed 3");
  std::mt19937_64 random{3};
  for (int i = 0; i < 1000; ++i) {
    const JointVector q = random_joints(*model, random);
    RedundancyIntervals found;
    EXPECT_TRUE(solver->feasible_redundancy(goal_at(*model, q), q, found));
    double nearest = 10;
    for (const RedundancyInterval& interval : found) {
      EXPECT_LE(interval.upper - interval.lower, 1e-6);
      nearest = std::min(nearest, std::abs(wrap_angle(interval.lower - *solver->redundancy_of(q))));
    }
    EXPECT_LE(nearest, 1e-7) << q.transpose();
    IkBranches branches;
    IkState state;
    EXPECT_EQ(solver->solve(goal_at(*model, q), JointVector::Zero(7), branches, state).code,
              IkStatus::Code::ok);
  }
}

}  // namespace
}  // namespace armature
