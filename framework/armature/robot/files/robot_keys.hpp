// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "armature/config/key.hpp"
#include "armature/robot/model/robot_model.hpp"

namespace armature ARMATURE_EXPORT {

// The keys of a robot file, map by map: what reading asks for, and what its JSON Schema is made of.

/// [rad/s] or [m/s], and of accelerations: what is slower does not move.
inline constexpr double kMinRate = 1e-6;
/// The range of a coupled joint for one of its leader, to either side. A screw of 0.1 mm a turn has
/// 62832 rad/m.
inline constexpr double kMinRatio = 1e-6, kMaxRatio = 1e6;

/// Of a file that has its joints in rows.
const std::vector<config::KeySpec>& robot_keys();
/// Of a file that has them from a URDF file.
const std::vector<config::KeySpec>& urdf_robot_keys();
/// Of a row under `joints:`; a coupled joint may leave its limits to its leader.
std::vector<config::KeySpec> joint_keys(Joint::Type type, bool is_coupled);
/// Of an entry of `joints:` beside `urdf:`.
std::vector<config::KeySpec> urdf_joint_keys(Joint::Type type);
/// Of `coupled:`.
std::vector<config::KeySpec> coupling_keys(Joint::Type type);
/// Of an entry of `frames:`.
const std::vector<config::KeySpec>& frame_keys();

/// Of an entry of `capsules:`.
const std::vector<config::KeySpec>& capsule_keys();
/// Of an entry of `masses:`.
const std::vector<config::KeySpec>& mass_keys();
/// Of `shaft:`.
const std::vector<config::KeySpec>& shaft_keys();

/// The words that `pointing_axis:` and a shaft's `axis:` may be instead of a list of 3 numbers:
/// "x",
/// "-x"...
const std::vector<std::string>& axis_words();

}  // namespace armature
