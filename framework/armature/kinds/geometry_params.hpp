// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Geometry>
#include <array>
#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

#include "armature/config/params.hpp"
#include "armature/robot/geometry/rotation.hpp"

namespace armature ARMATURE_EXPORT {

// Points and poses that a deployment states as lists of numbers.

/// Of a parameter with `count: 3`.
inline Eigen::Vector3d vector_of(const std::array<double, 3>& values) {
  return {values[0], values[1], values[2]};
}

/// Of two parameters with `count: 3`: the position, and roll, pitch and yaw.
inline Eigen::Isometry3d pose_of(const std::array<double, 3>& position,
                                 const std::array<double, 3>& rpy) {
  Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
  pose.translation() = vector_of(position);
  pose.linear() = rotation_from_rpy(vector_of(rpy));
  return pose;
}

/// x, y, z of each. Refuses numbers left over and for fewer than `least`, at least how many of
/// `what` there must be: "at least three markers". `name` is that of the parameter in `params`.
inline std::vector<Eigen::Vector3d> points_of(const std::vector<double>& values,
                                              const Params& params, std::string_view name,
                                              std::size_t least, std::string_view what) {
  if (values.size() < 3 * least || values.size() % 3 != 0) {
    params.refuse({name}, "'" + std::string{name} + "' has " + std::to_string(values.size()) +
                              " numbers; three for each of " + std::string{what} + " are needed");
  }
  std::vector<Eigen::Vector3d> points;
  for (std::size_t i = 0; i < values.size(); i += 3) {
    points.emplace_back(values[i], values[i + 1], values[i + 2]);
  }
  return points;
}

}  // namespace armature
