// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Geometry>

namespace armature ARMATURE_EXPORT {

/// Which of its rates a sample of an orientation is worked out with; the others stay zero.
enum class Rates { none, velocity, acceleration };

/// A rotation base_R_tool and how it changes with a parameter u; both rates in the base frame.
struct OrientationState {
  Eigen::Quaterniond rotation = Eigen::Quaterniond::Identity();
  Eigen::Vector3d velocity = Eigen::Vector3d::Zero();      // [rad / u]
  Eigen::Vector3d acceleration = Eigen::Vector3d::Zero();  // [rad / u^2]
};

}  // namespace armature
