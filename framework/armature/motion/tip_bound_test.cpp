// SPDX-License-Identifier: Apache-2.0
// How far the tip of an arm, and its shaft, are from where the reference has them.
#include "armature/motion/tip_bound.hpp"

#include <gtest/gtest.h>

#include <Eigen/QR>
#include <string>

#include "armature/robot/kinematics/kinematics.hpp"
#include "armature/robot/kinematics/remote_centre.hpp"

namespace armature {
namespace {

const RobotModel& scope() {
  static const RobotModel model =
      load_robot_model(ARMATURE_SOURCE_DIR "/configs/robots/med7_scope.yaml");
  return model;
}

TEST(TipBound, AnArmThatIsWhereItShallBeIsWithinAnyBound) {
  const JointVector home = resting_position(scope());
  EXPECT_TRUE(tip_violation(scope(), home, home, 1e-6).empty());
}

TEST(TipBound, AnglesTooSmallForTheJointsBoundAreToldInMillimetresOfTheTip) {
  const RobotModel lamp = load_robot_model(ARMATURE_SOURCE_DIR "/configs/robots/dental_lamp.yaml");
  const JointVector home = resting_position(lamp);
  JointVector bent = home;
  bent[1] += 0.03;
  const double off_m =
      (forward_kinematics(lamp, bent).translation() - forward_kinematics(lamp, home).translation())
          .norm();
  ASSERT_GT(off_m, 0.01);
  EXPECT_TRUE(tip_violation(lamp, bent, home, 1.001 * off_m).empty());
  EXPECT_EQ(tip_violation(lamp, bent, home, 0.002),
            ReasonText::format("the tip of the arm is {:.4g} mm away from the reference "
                               "(max_tip_deviation_m is 0.002)",
                               1e3 * off_m));
}

TEST(TipBound, AShaftThatSwingsAboutItsTipIsToldByItsEnd) {
  const JointVector home = resting_position(scope());
  const Shaft& shaft = *scope().shaft();
  const PoseAndJacobian at = forward_kinematics_with_jacobian(scope(), home, scope().tool());
  Eigen::Matrix<double, 6, 1> swing = Eigen::Matrix<double, 6, 1>::Zero();
  swing.tail<3>() = 0.02 * (at.base_T_frame.linear() * shaft.axis.unitOrthogonal());
  const JointVector turned =
      home + JointVector{at.jacobian.completeOrthogonalDecomposition().solve(swing)};
  const ReasonText said = tip_violation(scope(), turned, home, 0.002);
  EXPECT_EQ(std::string{said.view()}.find("the shaft's end of the arm is "), 0u) << said.view();
  EXPECT_TRUE(tip_violation(scope(), turned, home, 0.03).empty());
}

TEST(TipBound, OfAShaftWithinTheBoundNoPointLeavesItsIncisionByMore) {
  const JointVector home = resting_position(scope());
  const Eigen::Isometry3d shall_be = forward_kinematics(scope(), home);
  const RemoteCentre incision{.point = shall_be * Eigen::Vector3d{-0.1 * scope().shaft()->axis},
                              .shaft = *scope().shaft()};
  for (Eigen::Index joint = 0; joint < home.size(); ++joint) {
    JointVector bent = home;
    bent[joint] += 0.004;
    const double off_m = incision.deviation(forward_kinematics(scope(), bent));
    if (off_m > 0.001) {
      EXPECT_FALSE(tip_violation(scope(), bent, home, 0.001).empty()) << joint;
    }
  }
}

}  // namespace
}  // namespace armature
