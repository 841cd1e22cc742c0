// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Geometry>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "armature/config/node.hpp"
#include "armature/config/problems.hpp"
#include "armature/robot/model/robot_model.hpp"

namespace armature {

/// The joint that a frame or a body hangs on, -1 for the base, and where on it.
struct Parent {
  int joint = -1;
  Eigen::Isometry3d joint_T_parent = Eigen::Isometry3d::Identity();
};

/// What `parent:` may name in a robot file: 'base', and
///   with joints in rows: a joint, which is its row's frame, or a frame;
///   with a URDF file: a link or a frame. A joint's frame would be the Denavit-Hartenberg frame
///   that was made of it, which the file's author has never seen.
struct ParentNames {
  std::vector<Joint> joints;       // in rows; none with a URDF file
  std::vector<NamedFrame> frames;  // links, and what `frames:` adds
  bool is_urdf = false;
  /// With a URDF file, by a name in it that is no frame: why, and what to name.
  std::map<std::string, std::string> no_frames = {};
  /// Joints or links could not be read, which is told: nobody knows what is no parent.
  bool is_unread = false;

  std::optional<Parent> find(const std::string& name) const;
  /// Notes at `named` why that is no parent; `more` are frames that could have been meant, too.
  void refuse(const config::Node& named, const std::vector<std::string>& more,
              config::Problems& problems) const;
};

}  // namespace armature
