// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <string_view>
#include <utility>
#include <vector>

#include "armature/config/key.hpp"
#include "armature/runtime/plugins/plugin_manifest.hpp"

namespace armature ARMATURE_EXPORT {

// The keys of a deployment file, map by map, all but those that its plugins bring: what reading
// asks for, and what the JSON Schema is made of.

inline constexpr std::string_view kRobotsSection = "robots";
// The sections whose entries are files that components are bound to, and the word that a
// component (and a plugin's `uses:`) says for one of them.
inline constexpr std::array<std::pair<std::string_view, std::string_view>, 2> kDocumentSections{{
    {kRobotsSection, "robot"},
    {"rigs", "rig"},
}};

const std::vector<config::KeySpec>& deployment_keys();
const std::vector<config::KeySpec>& dds_keys();
const std::vector<config::KeySpec>& run_keys();
const std::vector<config::KeySpec>& record_keys();
/// Of an entry of `executors:`.
const std::vector<config::KeySpec>& executor_keys();
/// Of an entry of `sweep_goals:`.
const std::vector<config::KeySpec>& sweep_goal_keys();
/// Of an entry of `robots:` that is more than a path.
const std::vector<config::KeySpec>& robot_entry_keys();
/// Of an entry of `components:` that `runner` runs: its slots are keys, too. A host fills the first
/// of them itself.
std::vector<config::KeySpec> component_keys(const PluginManifest& runner, bool is_host);
/// Of what stands in a slot.
const std::vector<config::KeySpec>& slot_keys();

}  // namespace armature
