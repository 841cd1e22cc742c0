// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <memory>
#include <vector>

#include "armature/kinds/ik/test_goals.hpp"
#include "armature/robot/kinematics/kinematics.hpp"
#include "rrp_zyz.hpp"

namespace armature::testing {

using test::goal_at;
using test::random_joints;

inline std::shared_ptr<const RobotModel> master() {
  static const auto model = std::make_shared<const RobotModel>(
      load_robot_model(ARMATURE_SOURCE_DIR "/configs/robots/master.yaml"));
  return model;
}

/// The master manipulator with some of its joints or its tool changed.
template <class Change>
std::shared_ptr<const RobotModel> changed_master(Change change) {
  RobotParts parts{.name = "changed",
                   .convention = master()->convention(),
                   .joints = master()->joints(),
                   .frames = {{"tool", 5, Eigen::Isometry3d::Identity()}}};
  change(parts.joints, parts.frames.front().parent_T_frame);
  return std::make_shared<const RobotModel>(std::move(parts));
}

inline void turn_all_the_way(std::vector<Joint>& joints) {
  for (Joint& joint : joints) {
    if (joint.type == Joint::Type::prismatic) continue;
    joint.lower = -M_PI;
    joint.upper = M_PI;
  }
}

/// Other signs, offsets, twists and lengths, a tool off the wrist, joints that turn all the way.
inline std::shared_ptr<const RobotModel> another_master() {
  return changed_master([](auto& joints, auto& tool) {
    const std::array<double, 6> alpha{0.4, -M_PI / 2, -M_PI / 2, M_PI, M_PI / 2, M_PI / 2};
    for (std::size_t i = 0; i < 6; ++i) {
      joints[i].alpha = alpha[i];
      joints[i].theta = 0.7 * static_cast<double>(i) - 2;
    }
    turn_all_the_way(joints);
    joints[2].d = 0.6;
    joints[2].lower = -0.5;
    joints[2].upper = 1.2;
    tool.translate(Eigen::Vector3d{0.1, -0.2, 0.3});
    tool.rotate(Eigen::AngleAxisd{0.7, Eigen::Vector3d{1, 2, 3}.normalized()});
  });
}

inline std::shared_ptr<const IkSolver> solver_for(const RobotModel& model) {
  return std::move(RrpZyz::make(model, Params{}).value());
}

/// Largest joint difference, whole turns aside.
inline double distance(const RobotModel& model, const JointVector& a, const JointVector& b) {
  double largest = 0;
  for (int i = 0; i < model.dof(); ++i) {
    const double d = model.is_revolute(i) ? wrap_angle(a[i] - b[i]) : a[i] - b[i];
    largest = std::max(largest, std::abs(d));
  }
  return largest;
}

inline JointVector joints(const std::array<double, 6>& q) {
  return Eigen::Map<const Eigen::Matrix<double, 6, 1>>(q.data());
}

}  // namespace armature::testing
