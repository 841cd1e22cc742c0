// SPDX-License-Identifier: Apache-2.0
#include "armature/robot/model/robot_model.hpp"

#include <gtest/gtest.h>

#include "armature/robot/geometry/pose_goal.hpp"
#include "armature/robot/model/test_robots.hpp"

namespace armature {
namespace {

using testing::joint_vector;

TEST(WrapAngle, LandsInTheHalfOpenTurnAndDiffersByWholeTurns) {
  constexpr double kPi = std::numbers::pi;
  EXPECT_EQ(wrap_angle(kPi), -kPi);
  EXPECT_EQ(wrap_angle(-kPi), -kPi);
  EXPECT_EQ(wrap_angle(3 * kPi), -kPi);
  EXPECT_EQ(wrap_angle(0.1), 0.1);
  for (double angle = -30; angle < 30; angle += 0.01) {
    const double wrapped = wrap_angle(angle);
    ASSERT_GE(wrapped, -kPi);
    ASSERT_LT(wrapped, kPi);
    const double remainder = std::remainder(angle, 2 * kPi);
    ASSERT_EQ(wrapped, remainder >= kPi ? -kPi : remainder);
    ASSERT_NEAR(std::sin(wrapped), std::sin(angle), 1e-14);
    ASSERT_NEAR(std::cos(wrapped), std::cos(angle), 1e-14);
  }
}

TEST(RobotModel, ContractUndoesExpand) {
  std::mt19937 random{61};
  for (const RobotModel& robot :
       {testing::dental_lamp(), testing::synthetic_robot(RobotModel::Convention::standard, 3)})
    for (int n = 0; n < 100; ++n) {
      const JointVector q = testing::random_joints(robot, random);
      EXPECT_TRUE(*robot.to_independent(robot.to_all(q)) == q) << "seed 61";
    }
}

TEST(RobotModel, ExpandAppliesRatioAndOffset) {
  const RobotModel lamp = testing::dental_lamp();
  EXPECT_TRUE(lamp.to_all(joint_vector({1, 2, 0.3, 4, 5})) ==
              joint_vector({1, 2, 0.3, -0.3, 4, 5}));
  EXPECT_FALSE(std::signbit(lamp.to_all(JointVector::Zero(5))[3]));
  const RobotModel robot = testing::synthetic_robot(RobotModel::Convention::standard, 3);
  const JointVector all = robot.to_all(joint_vector({1, 2, 3, 4, 5}));
  EXPECT_NEAR(all[4], -1.5 * 2 + 0.3, 1e-15);
  EXPECT_NEAR(all[5], 0.7 * 3 - 0.1, 1e-15);
}

TEST(RobotModel, ContractSaysWhatIsWrong) {
  const RobotModel lamp = testing::dental_lamp();
  EXPECT_EQ(lamp.to_independent(joint_vector({1, 2, 3, 4, 5})).error().text,
            "5 joint values; dental_lamp has 6 joints");
  EXPECT_EQ(lamp.to_independent(joint_vector({1, 2, NAN, 4, 5, 6})).error().text,
            "j3 = nan is not a number");
  EXPECT_EQ(lamp.to_independent(joint_vector({0, 0, 0.5, 0.25, 0, 0})).error().text,
            "j4 = 0.25 contradicts its coupling to j3, which makes it -0.5");
  EXPECT_TRUE(lamp.to_independent(joint_vector({0, 0, 0.5, -0.5 + 9e-7, 0, 0})));
  EXPECT_EQ(lamp.to_independent(std::vector<double>(40, 0.0)).error().text,
            "40 joint values; dental_lamp has 6 joints");
}

TEST(RobotModel, ContractsRatesWithoutTheOffsetOfACoupling) {
  const RobotModel robot = testing::synthetic_robot(RobotModel::Convention::standard, 3);
  const std::vector<double> rates{1, 2, 3, 4, -1.5 * 2, 0.7 * 3, 5};
  EXPECT_EQ(robot.contract_rates(rates).value(), joint_vector({1, 2, 3, 4, 5}));
  EXPECT_FALSE(robot.to_independent(rates));
  EXPECT_EQ(robot.contract_rates(std::vector<double>{1, 2, 3, 4, 0, 0.7 * 3, 5}).error().text,
            "j5 = 0 contradicts its coupling to j2, which makes it -3");
}

TEST(RobotModel, TakesACoupledJointThatIsMeasuredByItselfWithinWhatIsStated) {
  RobotParts parts = testing::dental_lamp().parts();
  parts.joints[3].coupling->within = 2e-3;
  const RobotModel lamp{parts};
  EXPECT_EQ(lamp.to_independent(joint_vector({0, 0, 0.5, -0.5019, 0, 0})).value(),
            joint_vector({0, 0, 0.5, 0, 0}));
  EXPECT_EQ(lamp.to_independent(joint_vector({0, 0, 0.5, -0.5021, 0, 0})).error().text,
            "j4 = -0.5021 contradicts its coupling to j3, which makes it -0.5");
  EXPECT_EQ(lamp.contract_rates(std::vector<double>{0, 0, 0.5, 0.3, 0, 0}).value(),
            joint_vector({0, 0, 0.5, 0, 0}))
      << "two encoders never agree in their rates";
}

TEST(RobotModel, FoldsTheLimitsOfCoupledJointsIntoTheirLeaders) {
  const RobotModel robot = testing::synthetic_robot(RobotModel::Convention::standard, 3);
  // -2 <= -1.5 q + 0.3 <= 2
  EXPECT_NEAR(robot.lower()[1], -1.7 / 1.5, 1e-15);
  EXPECT_NEAR(robot.upper()[1], 2.3 / 1.5, 1e-15);
  EXPECT_NEAR(robot.max_velocity()[1], 2 / 1.5, 1e-15);
  EXPECT_NEAR(robot.max_acceleration()[1], 10 / 1.5, 1e-15);
  EXPECT_EQ(robot.upper()[2], 2);  // a slower follower takes nothing away
  EXPECT_EQ(robot.lower()[0], -2);
}

TEST(RobotModel, KnowsItsIndependentJoints) {
  const RobotModel robot = testing::synthetic_robot(RobotModel::Convention::standard, 3);
  EXPECT_EQ(robot.joint_count(), 7);
  EXPECT_EQ(robot.dof(), 5);
  EXPECT_EQ(robot.independent_joint(4), 6);
  EXPECT_FALSE(robot.is_revolute(2));
  EXPECT_TRUE(robot.is_revolute(4));
  EXPECT_FALSE(robot.find_frame("hand"));
  EXPECT_EQ(robot.frame(*robot.find_frame("elbow")).parent_joint, 3);
}

TEST(RobotModel, LimitsAreMetWithinATolerance) {
  const RobotModel lamp = testing::dental_lamp();
  JointVector q = lamp.upper();
  EXPECT_TRUE(lamp.within_limits(q));
  q[2] += 1e-3;
  EXPECT_FALSE(lamp.within_limits(q));
  EXPECT_TRUE(lamp.within_limits(q, 2e-3));
  q[2] = NAN;
  EXPECT_FALSE(lamp.within_limits(q));
}

TEST(RobotModel, RefusesPartsThatDoNotFit) {
  std::vector<Joint> joints(2);
  joints[0].name = "a";
  joints[0].coupling = Joint::Coupling{.to = 1};
  joints[1].coupling = Joint::Coupling{.to = 0};
  const std::vector<NamedFrame> frames{{"tool", 1, Eigen::Isometry3d::Identity()}};
  const auto make = [&](FrameId tool) {
    return RobotModel{
        {"r", RobotModel::Convention::standard, joints, frames, tool, std::nullopt, std::nullopt}};
  };
  EXPECT_THROW(make(FrameId{0}), std::invalid_argument);
  joints[1].coupling.reset();
  EXPECT_EQ(make(FrameId{0}).dof(), 1);
  EXPECT_THROW(make(FrameId{1}), std::invalid_argument);
  joints.resize(13);
  EXPECT_THROW(make(FrameId{0}), std::invalid_argument);
}

/// One joint, between these limits.
RobotModel joint_between(double lower, double upper) {
  Joint joint;
  joint.name = "slide";
  joint.type = Joint::Type::prismatic;
  joint.lower = lower;
  joint.upper = upper;
  return {{"one",
           RobotModel::Convention::standard,
           {joint},
           {{"tool", 0, Eigen::Isometry3d::Identity()}},
           FrameId{0},
           std::nullopt,
           std::nullopt}};
}

TEST(RobotModel, RestsWithinLimitsOfWhichOneIsInfinite) {
  EXPECT_EQ(resting_position(joint_between(1, INFINITY))[0], 1);
  EXPECT_EQ(resting_position(joint_between(-INFINITY, -2))[0], -2);
  EXPECT_EQ(resting_position(joint_between(-1, INFINITY))[0], 0);
  EXPECT_EQ(resting_position(joint_between(-INFINITY, INFINITY))[0], 0);
  EXPECT_EQ(resting_position(joint_between(1, 2))[0], 1.5);
}

TEST(RobotModel, RefusesLimitsThatAreTheWrongWayRound) {
  const auto reason = [](double lower, double upper) -> std::string {
    try {
      joint_between(lower, upper);
    } catch (const std::invalid_argument& error) {
      return error.what();
    }
    return "none";
  };
  EXPECT_EQ(reason(1, -1), "joint slide: its lower limit 1 is above its upper limit -1");
  EXPECT_EQ(reason(1, 1), "none");
}

TEST(PoseResidual, MeasuresDirectionsAndRotationsToTheLastDigit) {
  const Eigen::Isometry3d here = Eigen::Isometry3d::Identity();
  for (const double angle : {1e-12, 1e-6, 0.5, 3.0}) {
    const Eigen::Vector3d turned{std::cos(angle), std::sin(angle), 0};
    const auto pointing =
        residual(here, Eigen::Vector3d::UnitX(), {Eigen::Vector3d{0, 3, 4}, Direction{turned}});
    EXPECT_DOUBLE_EQ(pointing.position_m, 5);
    EXPECT_NEAR(pointing.angle_rad, angle, 1e-15);
    const Eigen::Quaterniond rotation{Eigen::AngleAxisd{angle, Eigen::Vector3d::UnitY()}};
    const auto turn = residual(here, Eigen::Vector3d::UnitX(), {here.translation(), rotation});
    EXPECT_EQ(turn.position_m, 0);
    EXPECT_NEAR(turn.angle_rad, angle, 1e-15);
  }
}

}  // namespace
}  // namespace armature
