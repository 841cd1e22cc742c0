// SPDX-License-Identifier: Apache-2.0
// Forward kinematics and Jacobians against KDL, for the URDF arms of tests/data and every arm of
// configs/robots, both read anew for KDL.
#include <gtest/gtest.h>

#include <filesystem>
#include <functional>
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
  RobotModel model;
  KDL::Chain chain;
};

/// Its file is read by the test that needs it: every test is a program of its own.
struct ArmFile {
  std::string name;
  std::function<Arm()> read;

  friend void PrintTo(const ArmFile& file, std::ostream* out) { *out << file.name; }
};

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

ArmFile urdf_arm(const std::string& name, const std::string& base, const std::string& tip) {
  const std::string file = ARMATURE_SOURCE_DIR "/tests/data/urdf/" + name + ".urdf";
  return {name, [=] {
            return Arm{load_urdf_robot(file, {base, {}}, {tip, {}}),
                       testing::kdl_chain_of_urdf(*urdf::parseURDFFile(file), base, tip)};
          }};
}

Arm arm_of_rows(const fs::path& file) {
  RobotModel model = load_robot_model(file);
  KDL::Chain chain = testing::kdl_chain_of_rows(model);
  chain.addSegment(
      KDL::Segment{KDL::Joint{KDL::Joint::None}, to_kdl(model.frame(model.tool()).parent_T_frame)});
  return {std::move(model), std::move(chain)};
}

std::vector<ArmFile> arms() {
  std::vector<ArmFile> list{
      urdf_arm("skew_puma", "world", "tool0"),   urdf_arm("skew_puma", "foot", "wrist_2"),
      urdf_arm("skew_puma", "column", "flange"), urdf_arm("seven_joints", "base_link", "hand"),
      urdf_arm("gantry", "rail", "gripper"),     urdf_arm("gantry", "beam", "camera")};
  for (const auto& entry : fs::directory_iterator{ARMATURE_SOURCE_DIR "/configs/robots"}) {
    const fs::path& file = entry.path();
    if (file.extension() != ".yaml") continue;
    list.push_back({file.stem().string(), [file] { return arm_of_rows(file); }});
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

class AgainstKdl : public ::testing::TestWithParam<ArmFile> {};

constexpr unsigned kSeed = 41;

TEST_P(AgainstKdl, ForwardKinematicsAreTheSame) {
  const Arm arm = GetParam().read();
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
  const Arm arm = GetParam().read();
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
