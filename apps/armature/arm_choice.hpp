// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "armature/config/params.hpp"
#include "armature/robot/model/robot_model.hpp"
#include "armature/runtime/plugins/plugin_manifest.hpp"

namespace armature {

/// The arm that a verb calculates with.
struct ArmChoice {
  std::string robot;  // a robot file, or a URDF file (*.urdf)
  std::string tip;    // frame that goals are stated for, instead of `tool`; of a URDF file a link
  std::string base;   // link of a URDF file; empty: its root
};
/// Throws config::ConfigError, and InvalidChoice when the robot has no such frame or base.
RobotModel load_arm(const ArmChoice& arm);

/// The plugin's parameters with those of `given`, a YAML map ("{max_restarts: 3}"), in place of the
/// defaults. Throws config::ConfigError.
Params params_of(const PluginManifest& plugin, const std::string& given);

}  // namespace armature
