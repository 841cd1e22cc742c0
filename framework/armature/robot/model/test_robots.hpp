// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <filesystem>
#include <numbers>
#include <random>
#include <string>

#include "armature/robot/model/robot_model.hpp"

namespace armature {
namespace testing ARMATURE_EXPORT {

/// Seven joints of random geometry, the third prismatic, two coupled (one of them follows the
/// prismatic joint); frames `tool` (turned and shifted, on the last joint), `elbow` (on the fourth)
/// and `foot` (on the base).
inline RobotModel synthetic_robot(RobotModel::Convention convention, unsigned seed) {
  std::mt19937 random{seed};
  std::uniform_real_distribution<double> any{-1, 1};
  std::vector<Joint> joints(7);
  for (std::size_t i = 0; i < joints.size(); ++i) {
    Joint& joint = joints[i];
    joint.name = "j" + std::to_string(i + 1);
    joint.theta = any(random);
    joint.d = any(random);
    joint.a = any(random);
    joint.alpha = i % 2 == 0 ? std::numbers::pi / 2 : any(random);
    joint.lower = -2;
    joint.upper = 2;
    joint.max_velocity = 2;
    joint.max_acceleration = 10;
  }
  joints[2].type = Joint::Type::prismatic;
  joints[4].coupling = Joint::Coupling{.to = 1, .ratio = -1.5, .offset = 0.3};
  joints[5].coupling = Joint::Coupling{.to = 2, .ratio = 0.7, .offset = -0.1};
  Eigen::Isometry3d offset = Eigen::Isometry3d::Identity();
  offset.translate(Eigen::Vector3d{0.1, -0.2, 0.3});
  offset.rotate(Eigen::AngleAxisd{0.7, Eigen::Vector3d{1, 2, 3}.normalized()});
  return RobotModel{{"synthetic",
                     convention,
                     joints,
                     {{"foot", -1, offset}, {"elbow", 3, offset}, {"tool", 6, offset}},
                     FrameId{2},
                     std::nullopt,
                     std::nullopt}};
}

/// The same with placements in front of the first and the fourth row.
inline RobotModel placed_robot(RobotModel::Convention convention, unsigned seed) {
  const RobotModel plain = synthetic_robot(convention, seed);
  std::vector<Joint> joints = plain.joints();
  joints[0].placement = joints[3].placement = plain.frames()[0].parent_T_frame;
  return RobotModel{{"placed", convention, joints, plain.frames(), plain.tool(), {}, {}}};
}

inline RobotModel dental_lamp() {
  return load_robot_model(std::filesystem::path{ARMATURE_SOURCE_DIR} /
                          "configs/robots/dental_lamp.yaml");
}

/// Uniform inside the limits.
inline JointVector random_joints(const RobotModel& model, std::mt19937& random) {
  constexpr double kTurn = 6.283185307179586;  // of a joint without limits
  JointVector q(model.dof());
  for (int i = 0; i < model.dof(); ++i) {
    q[i] = std::uniform_real_distribution<double>{std::max(model.lower()[i], -kTurn),
                                                  std::min(model.upper()[i], kTurn)}(random);
  }
  return q;
}

inline JointVector joint_vector(std::initializer_list<double> values) {
  JointVector result(static_cast<Eigen::Index>(values.size()));
  std::copy(values.begin(), values.end(), result.begin());
  return result;
}

}  // namespace testing
}  // namespace armature
