// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "armature/config/params.hpp"
#include "armature/robot/robot_model.hpp"
#include "armature/runtime/plugin_manifest.hpp"

namespace armature {

/// The arm that a verb calculates with.
struct ArmChoice {
  std::string robot;  // file
  std::string tip;    // frame that goals are stated for, instead of `tool`; empty: `tool`
};
/// Throws config::ConfigError, and InvalidChoice when the robot has no such frame.
RobotModel load_arm(const ArmChoice& arm);

/// The plugin's parameters with those of `given`, a YAML map ("{max_restarts: 3}"), in place of the
/// defaults. Throws config::ConfigError.
Params params_of(const PluginManifest& plugin, const std::string& given);

/// The robot files that came with this program, sorted.
std::vector<std::filesystem::path> shipped_robots();

}  // namespace armature
