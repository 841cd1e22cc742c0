// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <utility>
#include <vector>

#include "armature/kinds/ik/ik.hpp"

namespace armature::select::minmax {

inline Joint joint(std::string name, Joint::Type type, double limit, double velocity) {
  return {.name = std::move(name),
          .type = type,
          .lower = -limit,
          .upper = limit,
          .max_velocity = velocity,
          .max_acceleration = 1};
}

inline RobotModel robot_of(std::string name, std::vector<Joint> joints) {
  const NamedFrame tool{"tool", static_cast<int>(joints.size()) - 1, Eigen::Isometry3d::Identity()};
  return {{std::move(name),
           RobotModel::Convention::standard,
           std::move(joints),
           {tool},
           FrameId{0},
           {},
           {},
           {},
           {},
           {{"load", tool.parent_joint, {0.5, 0.2, 0}, 2}}}};
}

/// With a load of 2 kg on the last joint. Two revolute joints and a slide; the second joint is four
/// times faster than the first, which reaches some postures at two turns.
inline RobotModel crane() {
  using enum Joint::Type;
  return robot_of("crane", {joint("turn", revolute, 4, 1), joint("tilt", revolute, 3, 4),
                            joint("slide", prismatic, 10, 1)});
}

/// Two joints that turn round several times.
inline RobotModel winder() {
  using enum Joint::Type;
  return robot_of("winder", {joint("near", revolute, 8, 1), joint("far", revolute, 10, 2)});
}

inline JointVector joints(double turn, double tilt, double slide) {
  return Eigen::Vector3d{turn, tilt, slide};
}

inline IkBranches branches(const std::vector<JointVector>& qs) {
  IkBranches result;
  for (const JointVector& q : qs) result.add().q = q;
  return result;
}

}  // namespace armature::select::minmax
