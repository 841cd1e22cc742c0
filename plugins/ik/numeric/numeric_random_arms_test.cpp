// SPDX-License-Identifier: Apache-2.0
// Arms of four to nine joints, at random: turning and sliding, limited and not, some following
// others. What such an arm can reach is found, and what is found is right.
#include <gtest/gtest.h>

#include <random>

#include "armature/robot/geometry/pose_goal.hpp"
#include "armature/robot/kinematics/kinematics.hpp"
#include "numeric.hpp"

namespace armature::ik::numeric {
namespace {

constexpr double kPi = std::numbers::pi;
constexpr double kNone = std::numeric_limits<double>::infinity();

class RandomArms {
 public:
  explicit RandomArms(unsigned seed) : random_{seed} {}

  double between(double lower, double upper) {
    return std::uniform_real_distribution<double>{lower, upper}(random_);
  }
  bool one_in(int n) { return std::uniform_int_distribution<int>{1, n}(random_) == 1; }
  int whole(int lower, int upper) {
    return std::uniform_int_distribution<int>{lower, upper}(random_);
  }

  RobotModel arm() {
    const int count = whole(4, 9);
    std::vector<Joint> joints;
    for (int i = 0; i < count; ++i) joints.push_back(joint(i));
    if (one_in(2)) {  // the last joint follows another one
      const int to = whole(0, count - 2);
      const double ratios[] = {0.5, -1, 1, -0.5, 2};
      joints.back().coupling =
          Joint::Coupling{.to = to, .ratio = ratios[whole(0, 4)], .offset = 0.1};
      joints.back().type = joints[static_cast<std::size_t>(to)].type;
      joints.back().lower = -kNone, joints.back().upper = kNone;
    }
    return {{"random",
             RobotModel::Convention::standard,
             std::move(joints),
             {{"tool", count - 1, Eigen::Isometry3d::Identity()}},
             FrameId{0},
             {},
             {}}};
  }

  /// Joints within limits, half of those that have limits at one of them.
  JointVector place(const RobotModel& model) {
    JointVector q(model.dof());
    for (int j = 0; j < model.dof(); ++j) {
      const double lower = model.lower()[j], upper = model.upper()[j];
      const bool limited = std::isfinite(lower);
      q[j] = !limited ? between(-kPi, kPi) : between(lower, upper);
      if (limited && one_in(2)) q[j] = one_in(2) ? lower : upper;
    }
    return q;
  }

 private:
  Joint joint(int index) {
    const bool slides = one_in(6), endless = !slides && one_in(4);
    return {.name = "j" + std::to_string(index + 1),
            .type = slides ? Joint::Type::prismatic : Joint::Type::revolute,
            .d = between(0, 0.4),
            .a = between(0, 0.5),
            .alpha = whole(-1, 1) * kPi / 2 + (one_in(3) ? between(-1, 1) : 0),
            .lower = endless  ? -kNone
                     : slides ? 0
                              : -between(0.5, 3),
            .upper = endless  ? kNone
                     : slides ? between(0.2, 1)
                              : between(0.5, 3),
            .max_velocity = 1,
            .max_acceleration = 1};
  }

  std::mt19937 random_;
};

struct Count {
  int goals = 0, solved = 0, wrong = 0;
};

/// Whether what the solver calls a solution is one.
bool is_right(const RobotModel& model, const IkGoal& goal, const JointVector& q) {
  const PoseResidual off =
      residual(forward_kinematics(model, q), Eigen::Vector3d::UnitX(), goal.pose);
  for (int j = 0; j < model.dof(); ++j) {
    if (!(q[j] >= model.lower()[j] - 1e-8 && q[j] <= model.upper()[j] + 1e-8)) return false;
  }
  return off.position_m <= goal.tolerance.position_m && off.angle_rad <= goal.tolerance.angle_rad;
}

/// Goals that `model` reaches, each asked for from a place that has nothing to do with it, with so
/// many iterations for each.
void ask(RandomArms& arms, const RobotModel& model, int goals, int iterations, Count& count) {
  const Numeric solver{model, {.max_restarts = iterations / 10}};
  IkBranches branches;
  IkState state;
  for (int i = 0; i < goals; ++i) {
    const Eigen::Isometry3d pose = forward_kinematics(model, arms.place(model));
    const IkGoal goal{
        .pose = {.position = pose.translation(), .orientation = Eigen::Quaterniond{pose.linear()}},
        .max_iterations = iterations};
    ++count.goals;
    const IkStatus status = solver.solve(goal, arms.place(model), branches, state);
    if (status.code != IkStatus::Code::ok) continue;
    ++count.solved;
    for (const IkBranch& branch : branches) {
      if (branch.within_limits) {
        JointVector q = branch.q;
        unwind(model, branch.q, q);
        count.wrong += !is_right(model, goal, q);
      }
    }
  }
}

Count asked_of_500_arms(int iterations) {
  RandomArms arms{1};
  Count count;
  for (int i = 0; i < 500; ++i) ask(arms, arms.arm(), 20, iterations, count);
  return count;
}

TEST(Numeric, FindsWhatArmsAtRandomReachWithHalfOfTheirJointsAtLimits) {
  const Count hasty = asked_of_500_arms(IkGoal{}.max_iterations);
  EXPECT_EQ(hasty.wrong, 0);
  EXPECT_GE(hasty.solved, 0.998 * hasty.goals);
  const Count patient = asked_of_500_arms(20'000);
  EXPECT_EQ(patient.wrong, 0);
  EXPECT_GE(patient.solved, 0.9999 * patient.goals);
}

/// Six turns with limits, as an industrial arm's, on top of `first`.
RobotModel industrial_arm_on(Joint first) {
  first.name = "first";
  first.max_velocity = first.max_acceleration = 1;
  std::vector<Joint> joints{first};
  const double rows[][3] = {{0, 0, kPi / 2},      {0, 0.4318, 0},   {0.15, 0.0203, -kPi / 2},
                            {0.4318, 0, kPi / 2}, {0, 0, -kPi / 2}, {0.056, 0, 0}};
  for (const auto& [d, a, alpha] : rows) {
    joints.push_back({.name = "j" + std::to_string(joints.size()),
                      .d = d,
                      .a = a,
                      .alpha = alpha,
                      .lower = -2.2,
                      .upper = 2.2,
                      .max_velocity = 1,
                      .max_acceleration = 1});
  }
  return {{"on_first",
           RobotModel::Convention::standard,
           std::move(joints),
           {{"tool", 6, Eigen::Isometry3d::Identity()}},
           FrameId{0},
           {},
           {}}};
}

TEST(Numeric, FindsWhatAnArmReachesOfWhichOneJointFollowsAnEndlessOneByHalfItsAngle) {
  const RobotModel uncoupled =
      industrial_arm_on({.d = 0.3, .a = 0.2, .alpha = 0.5, .lower = -kNone, .upper = kNone});
  std::vector<Joint> joints = uncoupled.joints();
  joints[6].coupling = Joint::Coupling{.to = 0, .ratio = 0.5, .offset = 0};
  joints[6].lower = -kNone, joints[6].upper = kNone;
  const RobotModel model{{"half",
                          RobotModel::Convention::standard,
                          joints,
                          {{"tool", 6, Eigen::Isometry3d::Identity()}},
                          FrameId{0},
                          {},
                          {}}};
  RandomArms arms{2};
  Count count;
  ask(arms, model, 1000, 5000, count);
  EXPECT_EQ(count.solved, count.goals);
  EXPECT_EQ(count.wrong, 0);
}

TEST(Numeric, FindsWhatAnArmOnALongSlideReaches) {
  for (const double length : {1.0, 5.0, 50.0, 500.0}) {
    const RobotModel model = industrial_arm_on(
        {.type = Joint::Type::prismatic, .alpha = kPi / 2, .lower = 0, .upper = length});
    RandomArms arms{3};
    Count count;
    ask(arms, model, 1000, 5000, count);
    EXPECT_EQ(count.solved, count.goals) << length << " m";
    EXPECT_EQ(count.wrong, 0);
  }
}

}  // namespace
}  // namespace armature::ik::numeric
