// SPDX-License-Identifier: Apache-2.0
// Which plugin libraries of this machine load.
#include <fmt/format.h>

#include <map>

#include "armature/bus/fast_dds/observer.hpp"
#include "armature/bus/transport.hpp"
#include "armature/kinds/detector/detector.hpp"
#include "armature/kinds/face_pose/face_pose.hpp"
#include "armature/kinds/ik/ik.hpp"
#include "armature/kinds/landmarks/landmarks.hpp"
#include "armature/kinds/path/path.hpp"
#include "armature/kinds/registration/registration.hpp"
#include "armature/kinds/select/select.hpp"
#include "armature/kinds/target/target.hpp"
#include "armature/kinds/trajectory/trajectory_planner.hpp"
#include "armature/runtime/component/component.hpp"
#include "armature/runtime/plugins/plugin_library.hpp"
#include "armature/runtime/plugins/plugin_registry.hpp"
#include "doctor/gather.hpp"
#include "isolated.hpp"

namespace armature::doctor {
namespace {

constexpr double kPluginTimeout_s = 15;  // the trial in there has 5 s of its own

/// The version of every kind, which a plugin must be built for.
template <class... Kinds>
std::map<std::string_view, int> versions_of() {
  return {{Kinds::kKind, Kinds::kKindVersion}...};
}

const std::map<std::string_view, int>& kind_versions() {
  static const auto versions = versions_of<BranchSelector, Component, DdsObserver, FaceDetector,
                                           FacePoseEstimator, IkSolver, LandmarkFinder, PathPlanner,
                                           Registrar, TargetFilter, TrajectoryPlanner, Transport>();
  return versions;
}

/// Why a library does not load; empty: it does.
std::string reason_of(const PluginManifest& plugin) {
  const auto version = kind_versions().find(plugin.kind);
  if (version == kind_versions().end()) {
    return fmt::format("this armature knows no kind '{}'", plugin.kind);
  }
  const Isolated tried = isolated(kPluginTimeout_s, [&]() -> std::string {
    const auto loaded = PluginLibrary::load(plugin.file, plugin.kind, version->second);
    return loaded ? "" : loaded.error().text;
  });
  return tried.fault.empty() ? tried.result : tried.fault;
}

}  // namespace

PluginFacts plugin_facts() {
  const PluginRegistry plugins;
  PluginFacts facts{.folders = plugins.search_path(), .warnings = plugins.warnings()};
  for (const auto& [file, reason] : plugins.unusable()) facts.unusable.push_back({file, reason});
  for (const PluginManifest& plugin : plugins.plugins()) {
    const std::string reason = reason_of(plugin);
    if (reason.empty()) {
      ++facts.usable;
    } else {
      facts.unusable.push_back({plugin.file, reason});
    }
  }
  return facts;
}

}  // namespace armature::doctor
