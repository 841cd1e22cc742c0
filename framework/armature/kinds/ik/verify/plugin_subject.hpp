// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <string_view>

#include "armature/kinds/ik/contract/law.hpp"
#include "armature/runtime/plugins/plugin_registry.hpp"

// The laws of the kind for plugins that are found, not compiled in.
namespace armature ARMATURE_EXPORT {

/// A plugin's solver for a robot as a subject of the laws, or why the plugin refuses the robot;
/// what it promises is what its plugin.yaml provides. The library stays loaded as long as the
/// subject's solver. Throws PluginError when the library cannot be used.
Expected<IkSubject> plugin_subject(PluginRegistry& plugins, const PluginManifest& plugin,
                                   std::shared_ptr<const RobotModel> model, const Params& params);

/// What is wrong with the words that an ik plugin provides: "'all_brnches' is no promise of the
/// kind ik; did you mean 'all_branches'?"; empty when nothing is.
std::string wrong_promises(const PluginManifest& plugin);

/// The law of the library itself: loaded, asked once and unloaded `cycles` times (fewer when that
/// takes more than 60 s), the process is as it was.
inline constexpr std::string_view kIkLoadingLaw = "loading leaves nothing behind";
LawReport check_loading(const std::vector<std::filesystem::path>& search_path,
                        std::string_view plugin_id, const RobotModel& model, const Params& params,
                        int cycles);

}  // namespace armature
