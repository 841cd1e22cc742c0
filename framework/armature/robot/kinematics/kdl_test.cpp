// SPDX-License-Identifier: Apache-2.0
// Forward kinematics and Jacobians against KDL, for the URDF arms of tests/data and every arm of
// configs/robots, both read anew for KDL.
#include <gtest/gtest.h>

#include <kdl/chainfksolverpos_recursive.hpp>
#include <kdl/chainjnttojacsolver.hpp>
#include <numbers>
#include <random>

#include "armature/robot/files/urdf_robot.hpp"
#include "armature/robot/kinematics/kdl_chain_test.hpp"
#include "armature/robot/kinematics/kinematics.hpp"

namespace armature {
namespace {

namespace fs = std::filesystem;
using Eigen::Isometry3d;

/// An arm both ways; the chain's joints are all of the model's, in order.
struct Arm {
  std::string name;
  RobotModel model;
  KDL::Chain chain;
};

void PrintTo(const Arm& arm, std::ostream* out) { *out << arm.name; }

Isometry3d from_kdl(const KDL::Frame& frame) {
  Isometry3d T = Isometry3d::Identity();
  for (int row = 0; row < 3; ++row) {
    T.translation()[row] = frame.p[row];
    for (int col = 0; col < 3; ++col) T.linear()(row, col) = frame.M(row, col);
  }
  return T;
}

KDL::Frame to_kdl(const Isometry3d& T) {
  const auto& R = T.linear();
  const auto& p = T.translation();
  return {{R(0, 0), R(0, 1), R(0, 2), R(1, 0), R(1, 1), R(1, 2), R(2, 0), R(2, 1), R(2, 2)},
          {p.x(), p.y(), p.z()}};
}

Arm urdf_arm(const std::string& name, const std::string& base, const std::string& tip) {
  const std::string file = ARMATURE_SOURCE_DIR "/tests/data/urdf/" + name + ".urdf";
  return {name, load_urdf_robot(file, {base, {}}, {tip, {}}),
          testing::kdl_chain_of_urdf(*urdf::parseURDFFile(file), base, tip)};
}

std::vector<Arm> arms() {
  std::vector<Arm> list{
      urdf_arm("skew_puma", "world", "tool0"),   urdf_arm("skew_puma", "foot", "wrist_2"),
      urdf_arm("skew_puma", "column", "flange"), urdf_arm("seven_joints", "base_link", "hand"),
      urdf_arm("gantry", "rail", "gripper"),     urdf_arm("gantry", "beam", "camera")};
  for (const auto& entry : fs::directory_iterator{ARMATURE_SOURCE_DIR "/configs/robots"}) {
    if (entry.path().extension() != ".yaml") continue;
    RobotModel model = load_robot_model(entry.path());
    KDL::Chain chain = testing::kdl_chain_of_rows(model);
    chain.addSegment(KDL::Segment{KDL::Joint{KDL::Joint::None},
                                  to_kdl(model.frame(model.tool()).parent_T_frame)});
    list.push_back({model.name(), std::move(model), std::move(chain)});
  }
  return list;
}

KDL::JntArray all_joints(const Arm& arm, const JointVector& q) {
  KDL::JntArray all(static_cast<unsigned>(arm.model.joint_count()));
  all.data = arm.model.to_all(q);
  return all;
}

/// Anywhere within limits, or within two turns where there are none.
JointVector anywhere(const RobotModel& model, std::mt19937& random) {
  JointVector q(model.dof());
  for (int i = 0; i < model.dof(); ++i) {
    const bool limited = std::isfinite(model.upper()[i]);
    const double most = 2 * std::numbers::pi;
    q[i] = std::uniform_real_distribution{limited ? model.lower()[i] : -most,
                                          limited ? model.upper()[i] : most}(random);
  }
  return q;
}

/// All joints' columns to independent ones.
Jacobian folded(const RobotModel& model, const Eigen::MatrixXd& all) {
  Jacobian J = Jacobian::Zero(6, model.dof());
  for (int i = 0; i < model.joint_count(); ++i) {
    const ChainLink& link = model.chain()[static_cast<std::size_t>(i)];
    J.col(link.independent) += link.ratio * all.col(i);
  }
  return J;
}

class AgainstKdl : public ::testing::TestWithParam<Arm> {};

constexpr unsigned kSeed = 41;

TEST_P(AgainstKdl, ForwardKinematicsAreTheSame) {
  const Arm& arm = GetParam();
  ASSERT_EQ(static_cast<int>(arm.chain.getNrOfJoints()), arm.model.joint_count());
  KDL::ChainFkSolverPos_recursive kdl{arm.chain};
  std::mt19937 random{kSeed};
  for (int i = 0; i < 2000; ++i) {
    const JointVector q = anywhere(arm.model, random);
    SCOPED_TRACE(::testing::Message() << "seed " << kSeed << ", q " << q.transpose());
    KDL::Frame expected;
    ASSERT_GE(kdl.JntToCart(all_joints(arm, q), expected), 0);
    const Isometry3d T = forward_kinematics(arm.model, q);
    ASSERT_LT((T.matrix() - from_kdl(expected).matrix()).cwiseAbs().maxCoeff(), 3e-14);
  }
}

TEST_P(AgainstKdl, JacobiansAreTheSame) {
  const Arm& arm = GetParam();
  KDL::ChainJntToJacSolver kdl{arm.chain};
  KDL::Jacobian expected{arm.chain.getNrOfJoints()};
  std::mt19937 random{kSeed + 1};
  for (int i = 0; i < 2000; ++i) {
    const JointVector q = anywhere(arm.model, random);
    SCOPED_TRACE(::testing::Message() << "seed " << kSeed + 1 << ", q " << q.transpose());
    ASSERT_GE(kdl.JntToJac(all_joints(arm, q), expected), 0);
    const auto [T, J] = forward_kinematics_with_jacobian(arm.model, q, arm.model.tool());
    ASSERT_LT((J - folded(arm.model, expected.data)).cwiseAbs().maxCoeff(), 3e-14);
  }
}

INSTANTIATE_TEST_SUITE_P(Arms, AgainstKdl, ::testing::ValuesIn(arms()), [](const auto& arm) {
  return arm.param.name + "_" + std::to_string(arm.index);
});

}  // namespace
}  // namespace armature
