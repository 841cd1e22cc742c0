// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Geometry>
#include <vector>

#include "armature/kinds/path/path.hpp"

namespace armature::path::orientations {

/// Where a path must go through: start, key poses, goal; of poses that are no farther apart than
/// 1e-6 m and rad the first stays, of the goal the goal. A direction has become a rotation that
/// takes x to it, turned from key to key by no more than it takes.
struct KeyPoses {
  std::vector<ToolPose> poses;
  std::vector<Eigen::Vector3d> positions;
  std::vector<Eigen::Quaterniond> rotations;
  bool pointing = false;

  void add(const ToolPose& pose, const Eigen::Quaterniond& rotation);
  void remove_last();
  /// A rotation of the curve as the request tells orientations.
  Orientation told(const Eigen::Quaterniond& rotation) const;
};

/// Of a checked request. Refuses poses of which some are directions and some rotations, and a
/// direction that is opposite to the one before.
Expected<KeyPoses> key_poses_of(const PathRequest& request);

/// From 0 to 1; between keys in proportion to their part of the whole turn plus their part of the
/// whole way: keys on one place have one angular speed, keys of one orientation one speed.
std::vector<double> key_parameters(const KeyPoses& keys);

}  // namespace armature::path::orientations
