// SPDX-License-Identifier: Apache-2.0
// A redundancy that is asked for is held or refused, never passed over.
#include <gtest/gtest.h>

#include <cmath>
#include <memory>
#include <optional>
#include <random>
#include <string>
#include <utility>

#include "armature/kinds/ik/test_goals.hpp"
#include "armature/robot/kinematics/kinematics.hpp"
#include "armature/robot/model/robot_model.hpp"
#include "numeric.hpp"

namespace armature::ik::numeric {
namespace {

RobotModel robot(const std::string& name) {
  return load_robot_model(ARMATURE_SOURCE_DIR "/configs/robots/" + name + ".yaml");
}
/// The SR-1 whose sixth joint turns the needle, for goals that leave that turn free.
RobotModel pointing_sr1() {
  const RobotModel sr1 = robot("sr1");
  return {{sr1.name(), sr1.convention(), sr1.joints(), sr1.frames(), sr1.tool(),
           Eigen::Vector3d::UnitZ(), sr1.home()}};
}

class NumericRedundancy : public testing::Test {
 protected:
  explicit NumericRedundancy(RobotModel model = robot("sr1_needle"))
      : model_{std::move(model)}, solver_{std::make_unique<Numeric>(model_, Parameters{})} {}

  JointVector random_joints() {
    std::uniform_real_distribution<double> part{0, 1};
    JointVector q(model_.dof());
    for (int i = 0; i < q.size(); ++i) {
      q[i] = std::lerp(model_.lower()[i], model_.upper()[i], part(random_));
    }
    return q;
  }
  IkGoal pointing_at(const JointVector& q) const {
    const Eigen::Isometry3d pose = forward_kinematics(model_, q);
    IkGoal goal;
    goal.pose = {pose.translation(), Direction{pose.linear() * model_.pointing_axis().value()}};
    return goal;
  }
  IkGoal turned_as(const JointVector& q) const { return test::goal_at(model_, q); }
  IkStatus solve(const IkGoal& goal, const JointVector& seed) {
    IkState state;
    return solver_->solve(goal, seed, found_, state);
  }
  /// Of 1000 goals, each with the last joint's value of the joints that made it.
  void expect_held() {
    SCOPED_TRACE("seed 5");
    int reached = 0;
    for (int i = 0; i < 1000; ++i) {
      const JointVector q = random_joints();
      IkGoal goal = pointing_at(q);
      goal.redundancy = solver_->redundancy_of(q);
      const double value = goal.redundancy.value();
      ASSERT_NEAR(wrap_angle(value - q[5]), 0, 1e-14);
      reached += solve(goal, random_joints()).code == IkStatus::Code::ok ? 1 : 0;
      for (const IkBranch& branch : found_) {
        ASSERT_EQ(branch.q[5], value);
        ASSERT_EQ(branch.redundancy, value);
        const auto left =
            residual(forward_kinematics(model_, branch.q), *model_.pointing_axis(), goal.pose);
        ASSERT_LE(left.position_m, goal.tolerance.position_m);
        ASSERT_LE(left.angle_rad, goal.tolerance.angle_rad);
      }
    }
    EXPECT_GE(reached, 990);
  }
  void expect_refused(const IkGoal& goal, const std::string& reason) {
    const IkStatus status = solve(goal, *model_.home());
    EXPECT_EQ(status.code, IkStatus::Code::invalid_input);
    EXPECT_EQ(status.detail, reason);
    EXPECT_EQ(found_.count, 0);
  }

  RobotModel model_;
  std::unique_ptr<IkSolver> solver_;
  IkBranches found_;
  std::mt19937_64 random_{5};
};

TEST_F(NumericRedundancy, TheDepthOfASlidingNeedleIsHeld) {
  EXPECT_TRUE(solver_->redundancy_is_length());
  expect_held();
}

TEST_F(NumericRedundancy, WithoutOneAskedForTheNeedleIsFreeToMove) {
  const JointVector home = *model_.home();
  JointVector seed = home;
  seed[5] += 0.05;
  ASSERT_EQ(solve(pointing_at(home), seed).code, IkStatus::Code::ok);
  EXPECT_NE(found_.begin()->q[5], seed[5]);
  EXPECT_EQ(found_.begin()->redundancy, found_.begin()->q[5]);
}

TEST_F(NumericRedundancy, ADepthBeyondTheNeedlesRangeIsAJointLimit) {
  IkGoal goal = pointing_at(*model_.home());
  goal.redundancy = model_.upper()[5] + 0.01;
  const IkStatus status = solve(goal, *model_.home());
  EXPECT_EQ(status.code, IkStatus::Code::joint_limit);
  EXPECT_EQ(status.detail, "the redundancy asked for is beyond the limits of the last joint");
  EXPECT_EQ(found_.count, 0);
}

TEST_F(NumericRedundancy, WhereNothingIsRedundantOneIsRefused) {
  IkGoal goal = turned_as(*model_.home());
  goal.redundancy = 0.1;
  expect_refused(goal, "the goal leaves this arm nothing redundant");
}

TEST_F(NumericRedundancy, OneThatIsNoNumberIsRefused) {
  IkGoal goal = pointing_at(*model_.home());
  goal.redundancy = NAN;
  expect_refused(goal, "the redundancy is not finite");
}

struct TurningNumericRedundancy : NumericRedundancy {
  TurningNumericRedundancy() : NumericRedundancy{pointing_sr1()} {}
};
TEST_F(TurningNumericRedundancy, TheTurnAboutTheDirectionIsHeld) {
  EXPECT_FALSE(solver_->redundancy_is_length());
  expect_held();
}

TEST_F(TurningNumericRedundancy, AWholeTurnMoreIsTheSame) {
  IkGoal goal = pointing_at(*model_.home());
  goal.redundancy = (*model_.home())[5] + 2 * M_PI;
  ASSERT_EQ(solve(goal, *model_.home()).code, IkStatus::Code::ok);
  EXPECT_NEAR(found_.begin()->q[5], (*model_.home())[5], 1e-12);
}

struct SevenJointNumericRedundancy : NumericRedundancy {
  SevenJointNumericRedundancy() : NumericRedundancy{robot("med7")} {}
};
TEST_F(SevenJointNumericRedundancy, AnArmAngleIsRefusedByName) {
  EXPECT_EQ(solver_->redundancy_of(*model_.home()), std::nullopt);
  IkGoal goal = turned_as(*model_.home());
  EXPECT_EQ(solve(goal, *model_.home()).code, IkStatus::Code::ok);
  goal.redundancy = 0.3;
  expect_refused(goal,
                 "ik/numeric holds no arm angle, only a last joint along the pointing axis; leave "
                 "the redundancy out or take a solver for this arm (S-R-S: ik/srs_arm_angle)");
}

}  // namespace
}  // namespace armature::ik::numeric
