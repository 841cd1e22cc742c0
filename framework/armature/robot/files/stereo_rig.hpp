// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Geometry>
#include <filesystem>
#include <string>
#include <vector>

#include "armature/config/key.hpp"
#include "armature/robot/geometry/stereo_camera.hpp"

namespace armature {
namespace config ARMATURE_EXPORT {
class Node;
}  // namespace config
}  // namespace armature

namespace armature ARMATURE_EXPORT {

/// The optical frames of a stereo head, as the headers of pictures and face poses name them.
inline constexpr const char* kLeftCameraFrame = "left_camera_optical";
inline constexpr const char* kRightCameraFrame = "right_camera_optical";

/// A stereo head: two equal, rectified pinhole cameras mounted on a frame of the arm.
struct StereoRig {
  std::string name;
  StereoCamera camera;
  std::string mounted_on;  // a named frame of the robot
  /// Left camera's optical frame (REP 103: x right, y down, z forward) in the frame it hangs on;
  /// the right camera sits baseline_m along the left one's x.
  Eigen::Isometry3d mount_T_left = Eigen::Isometry3d::Identity();
};

/// Reads an `armature_rig: 1` document: {name, resolution: [w, h], fov_deg | focal_px, (principal
/// point optional, the image centre), baseline_mm, mount: {frame: tool, center_mm: [0,0,0],
/// forward: [1,0,0], right: [0,0,1]}}; `center` is the middle between both cameras. Throws
/// config::ConfigError with everything that is wrong.
StereoRig read_stereo_rig(const config::Node& document);
/// The same from a file.
StereoRig load_stereo_rig(const std::filesystem::path& file);

/// The keys of a rig file and those of its `mount:`.
const std::vector<config::KeySpec>& rig_keys();
const std::vector<config::KeySpec>& mount_keys();

}  // namespace armature
