// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <vector>

#include "armature/calibration/hand_eye.hpp"
#include "armature/robot/model/robot_model.hpp"

namespace armature ARMATURE_EXPORT {

// A file of recorded poses is JSON lines, one record each, or YAML:
//
//   armature_poses: 1
//   poses:
//     - joints: [0, 0.5, 0, 1.2, 0, 0.5, 0]    # all joints of the robot; or base_T_flange
//       tracker_T_body: {position_m: [0.73, 1.06, 0.64], quaternion_xyzw: [0.1, 0.5, 0.3, 0.8]}
//
// The flange is the robot's tool frame (`load_arm` with another tip). Everything that is wrong is
// thrown at once as config::ConfigError, with its place.

/// Records of a flange and a body. Without a `robot`, `joints` are a problem.
std::vector<HandEyePose> read_hand_eye_poses(const std::filesystem::path& file,
                                             const RobotModel* robot);

/// The poses of what a tool is fixed to.
struct ToolPoses {
  std::vector<Eigen::Isometry3d> fixed_T_body;
  bool is_tracked = false;  // tracker_T_body; else base_T_flange
};
/// Records of either a flange or a body, the same in all of them.
ToolPoses read_tool_poses(const std::filesystem::path& file, const RobotModel* robot);

}  // namespace armature
