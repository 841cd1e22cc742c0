// SPDX-License-Identifier: Apache-2.0
#include "armature/robot/kinematics/kinematics.hpp"

#include <gtest/gtest.h>

#include "armature/robot/model/axis_steps.hpp"
#include "armature/robot/model/test_robots.hpp"

namespace armature {
namespace {

using Eigen::Isometry3d;
using Eigen::Vector3d;
using testing::random_joints;

/// The D-H product as a textbook writes it, with full matrices.
Isometry3d textbook_kinematics(const RobotModel& model, const JointVector& independent,
                               FrameId frame) {
  const JointVector all = model.to_all(independent);
  Isometry3d T = Isometry3d::Identity();
  for (int i = 0; i <= model.frame(frame).parent_joint; ++i) {
    const Joint& joint = model.joints()[static_cast<std::size_t>(i)];
    const bool slides = joint.type == Joint::Type::prismatic;
    const Eigen::AngleAxisd about_z{joint.theta + (slides ? 0 : all[i]), Vector3d::UnitZ()};
    const Eigen::Translation3d along_z{0, 0, joint.d + (slides ? all[i] : 0)};
    const Eigen::AngleAxisd about_x{joint.alpha, Vector3d::UnitX()};
    const Eigen::Translation3d along_x{joint.a, 0, 0};
    T = T * joint.placement.value_or(Isometry3d::Identity());
    if (model.convention() == RobotModel::Convention::standard)
      T = T * about_z * along_z * along_x * about_x;
    else
      T = T * about_x * along_x * about_z * along_z;
  }
  return T * model.frame(frame).parent_T_frame;
}

/// Central differences of the pose; the rotation through the skew part of dR R^T.
Jacobian numeric_jacobian(const RobotModel& model, const JointVector& q, FrameId frame) {
  constexpr double kStep = 1e-6;
  const Eigen::Matrix3d R = forward_kinematics(model, q, frame).linear();
  Jacobian result(6, model.dof());
  for (int i = 0; i < model.dof(); ++i) {
    JointVector before = q, behind = q;
    before[i] -= kStep;
    behind[i] += kStep;
    const Isometry3d a = forward_kinematics(model, before, frame);
    const Isometry3d b = forward_kinematics(model, behind, frame);
    const Eigen::Matrix3d spin = (b.linear() - a.linear()) / (2 * kStep) * R.transpose();
    result.col(i).head<3>() = (b.translation() - a.translation()) / (2 * kStep);
    result.col(i).tail<3>() << spin(2, 1) - spin(1, 2), spin(0, 2) - spin(2, 0),
        spin(1, 0) - spin(0, 1);
    result.col(i).tail<3>() *= 0.5;
  }
  return result;
}

std::vector<RobotModel> robots() {
  std::vector<RobotModel> all{testing::dental_lamp()};
  for (unsigned seed = 1; seed <= 5; ++seed) {
    all.push_back(testing::synthetic_robot(RobotModel::Convention::standard, seed));
    all.push_back(testing::synthetic_robot(RobotModel::Convention::modified, seed));
    all.push_back(testing::placed_robot(RobotModel::Convention::standard, seed));
    all.push_back(testing::placed_robot(RobotModel::Convention::modified, seed));
  }
  return all;
}

TEST(Kinematics, EqualsTheDenavitHartenbergProductInBothConventions) {
  std::mt19937 random{11};
  for (const RobotModel& robot : robots())
    for (int n = 0; n < 200; ++n) {
      const JointVector q = random_joints(robot, random);
      SCOPED_TRACE(::testing::Message() << "seed 11, " << robot.name() << ", q " << q.transpose());
      for (int f = 0; f < static_cast<int>(robot.frames().size()); ++f)
        ASSERT_LT((forward_kinematics(robot, q, FrameId{f}).matrix() -
                   textbook_kinematics(robot, q, FrameId{f}).matrix())
                      .cwiseAbs()
                      .maxCoeff(),
                  1e-13);
    }
}

TEST(Kinematics, JacobianEqualsCentralDifferencesOfEveryFrame) {
  std::mt19937 random{12};
  for (const RobotModel& robot : robots())
    for (int n = 0; n < 200; ++n) {
      const JointVector q = random_joints(robot, random);
      SCOPED_TRACE(::testing::Message() << "seed 12, " << robot.name() << ", q " << q.transpose());
      for (int f = 0; f < static_cast<int>(robot.frames().size()); ++f) {
        const FrameId frame{f};
        const auto [pose, jacobian] = forward_kinematics_with_jacobian(robot, q, frame);
        ASSERT_LT((jacobian - numeric_jacobian(robot, q, frame)).cwiseAbs().maxCoeff(), 2e-9);
        ASSERT_TRUE(pose.matrix() == forward_kinematics(robot, q, frame).matrix());
      }
    }
}

TEST(AxisSteps, AndTheJointsBetweenThemAreForwardKinematics) {
  std::mt19937 random{17};
  for (const RobotModel& robot : robots())
    for (int f = 0; f < static_cast<int>(robot.frames().size()); ++f) {
      const FrameId frame{f};
      const auto steps = axis_steps(robot, frame);
      ASSERT_EQ(static_cast<int>(steps.size()), robot.frame(frame).parent_joint + 2);
      const JointVector q = random_joints(robot, random), all = robot.to_all(q);
      Isometry3d T = steps[0];
      for (std::size_t i = 1; i < steps.size(); ++i) {
        const double value = all[static_cast<Eigen::Index>(i) - 1];
        if (robot.joints()[i - 1].type == Joint::Type::prismatic)
          T.translate(Vector3d{0, 0, value});
        else
          T.rotate(Eigen::AngleAxisd{value, Vector3d::UnitZ()});
        T = T * steps[i];
      }
      ASSERT_LT((T.matrix() - forward_kinematics(robot, q, frame).matrix()).norm(), 1e-13)
          << "seed 17, " << robot.name();
    }
}

TEST(Kinematics, FrameOnTheBaseDoesNotMove) {
  const RobotModel robot = testing::synthetic_robot(RobotModel::Convention::standard, 1);
  const FrameId foot = *robot.find_frame("foot");
  std::mt19937 random{13};
  const auto result = forward_kinematics_with_jacobian(robot, random_joints(robot, random), foot);
  EXPECT_TRUE(result.base_T_frame.matrix() == robot.frame(foot).parent_T_frame.matrix());
  EXPECT_TRUE(result.jacobian.isZero(0));
}

TEST(DentalLampKinematics, EqualsTheClosedForm) {
  const RobotModel lamp = testing::dental_lamp();
  constexpr double d1 = 0.45257, a1 = 0.61, d2 = 0.2515, a3 = 0.6, a4 = 0.2, d5 = -0.2, a5 = 0.2,
                   a6 = 0.08;
  std::mt19937 random{14};
  for (int n = 0; n < 10000; ++n) {
    const JointVector q = random_joints(lamp, random);
    SCOPED_TRACE(::testing::Message() << "seed 14, q " << q.transpose());
    const double q1 = q[0], q12 = q[0] + q[1], q3 = q[2], psi = q[0] + q[1] + q[3], q6 = q[4];
    const double l = a3 * std::cos(q3) + a4, r = a5 + a6 * std::cos(q6);
    const Vector3d position{a1 * std::cos(q1) + l * std::cos(q12) + r * std::cos(psi),
                            a1 * std::sin(q1) + l * std::sin(q12) + r * std::sin(psi),
                            d1 + d2 + d5 + a3 * std::sin(q3) + a6 * std::sin(q6)};
    const Vector3d x7{std::cos(q6) * std::cos(psi), std::cos(q6) * std::sin(psi), std::sin(q6)};
    const Vector3d z7{std::sin(psi), -std::cos(psi), 0};
    const Isometry3d T = forward_kinematics(lamp, q);
    ASSERT_LT((T.translation() - position).norm(), 1e-12);
    ASSERT_LT((T.linear().col(0) - x7).norm(), 1e-12);
    ASSERT_LT((T.linear().col(2) - z7).norm(), 1e-12);
  }
}

TEST(DentalLampKinematics, CamerasNeverRoll) {
  const RobotModel lamp = testing::dental_lamp();
  std::mt19937 random{15};
  for (int n = 0; n < 1000; ++n)
    ASSERT_EQ(forward_kinematics(lamp, random_joints(lamp, random)).linear()(2, 2), 0.0);
}

TEST(DentalLampKinematics, ManipulabilityIsTheDeterminantOfTheFiveByFiveJacobian) {
  const RobotModel lamp = testing::dental_lamp();
  std::mt19937 random{16};
  for (int n = 0; n < 10000; ++n) {
    const JointVector q = random_joints(lamp, random);
    SCOPED_TRACE(::testing::Message() << "seed 16, q " << q.transpose());
    const double l = 0.6 * std::cos(q[2]) + 0.2;
    const double det = 0.61 * l * std::sin(q[1]) * 0.6 * std::cos(q[2]) * std::cos(q[4]);
    ASSERT_NEAR(manipulability(lamp, q), std::abs(det), 1e-14);
  }
}

TEST(Manipulability, VanishesWhereTheLampIsStretchedAndWhereARobotHasTooFewJoints) {
  const RobotModel lamp = testing::dental_lamp();
  EXPECT_LT(manipulability(lamp, JointVector::Zero(5)), 1e-16);
  EXPECT_EQ(manipulability(testing::synthetic_robot(RobotModel::Convention::standard, 1),
                           JointVector::Zero(5)),
            0.0);
}

}  // namespace
}  // namespace armature
