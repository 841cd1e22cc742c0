// SPDX-License-Identifier: Apache-2.0
#include "bench/perception/chosen_perception.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <stdexcept>
#include <utility>

#include "armature/config/document.hpp"
#include "armature/config/problems.hpp"
#include "armature/config/source_text.hpp"
#include "armature/robot/files/stereo_rig.hpp"
#include "armature/runtime/deployment_file/deployment_config.hpp"
#include "armature/scene/scene_renderer.hpp"
#include "exit_code.hpp"
#include "inspect/plugins.hpp"
#include "run/named_deployment.hpp"

namespace armature::bench {
namespace {

/// The component of the deployment that runs `kind` on topics.
const ComponentConfig& host_of(std::string_view kind, const DeploymentConfig& deployment) {
  const auto host = std::ranges::find_if(deployment.components, [&](const ComponentConfig& one) {
    return one.manifest->hosts == kind;
  });
  if (host != deployment.components.end()) return *host;
  throw InvalidChoice(
      fmt::format("no component of '{}' is a '{}' plugin; its perception cannot be measured",
                  deployment.name, kind));
}

/// The first rig that a component is bound to.
StereoRig rig_of(const DeploymentConfig& deployment) {
  for (const ComponentConfig& component : deployment.components) {
    const auto bound = component.documents.find("rigs");
    if (bound == component.documents.end()) continue;
    StereoRig rig = read_stereo_rig(deployment.documents.at("rigs").at(bound->second));
    if (rig.camera.width <= scene::SceneRenderer::kWidestImage) return rig;
    throw InvalidChoice(fmt::format("the rig '{}' is {} px wide; the bench draws at most {}",
                                    rig.name, rig.camera.width,
                                    scene::SceneRenderer::kWidestImage));
  }
  throw InvalidChoice(
      fmt::format("no component of '{}' has a rig: there is no stereo pair to "
                  "draw pictures for",
                  deployment.name));
}

/// The plugin that sits in the slot of its own kind, or `chosen` instead.
template <class Kind>
PluginPtr<Kind> make(PluginRegistry& plugins, const ComponentConfig& host,
                     const std::string& chosen, std::string& id) {
  const auto slot = std::ranges::find_if(
      host.slots, [&](const SlotConfig& one) { return one.manifest->kind == Kind::kKind; });
  if (slot == host.slots.end()) {
    throw InvalidChoice(fmt::format("'{}' has no slot for a '{}'", host.name, Kind::kKind));
  }
  id = chosen.empty() ? slot->plugin_id : chosen;
  const PluginManifest* plugin = plugins.find(id);
  if (!plugin) throw InvalidChoice(plugins.unknown_text(id));
  if (plugin->kind != Kind::kKind) {
    throw InvalidChoice(
        fmt::format("'{}' is of kind '{}', and a '{}' is needed", id, plugin->kind, Kind::kKind));
  }
  config::Problems problems;
  const Params params = id == slot->plugin_id
                            ? slot->params
                            : Params::read(plugin->params, nullptr, plugin->id, problems);
  problems.throw_if_any();
  auto made = plugins.make<Kind>(id, params);
  if (!made) throw std::runtime_error(fmt::format("{} refuses: {}", id, made.error().text));
  return std::move(*made);
}

}  // namespace

ChosenPerception chosen_perception(PluginRegistry& plugins, const DeploymentSource& source,
                                   const PerceptionChoice& choice) {
  tell_warnings(plugins);
  const DeploymentConfig deployment = read_named(source, plugins);
  const ComponentConfig& finds = host_of(LandmarkFinder::kKind, deployment);
  const ComponentConfig& estimates = host_of(FacePoseEstimator::kKind, deployment);
  const StereoRig rig = rig_of(deployment);
  ChosenPerception chosen;
  chosen.deployment = deployment.name;
  chosen.rig = rig.name;
  chosen.camera = rig.camera;
  chosen.search = {.stretch_below = finds.params.number("stretch_below"),
                   .detect_every = static_cast<int>(finds.params.integer("detect_every"))};
  chosen.detector = make<FaceDetector>(plugins, finds, choice.detector, chosen.detector_id);
  chosen.landmarks = make<LandmarkFinder>(plugins, finds, choice.landmarks, chosen.landmarks_id);
  chosen.face_pose =
      make<FacePoseEstimator>(plugins, estimates, choice.face_pose, chosen.face_pose_id);
  const bool asks_again = std::ranges::any_of(estimates.slots, [](const SlotConfig& slot) {
    return slot.manifest->kind == LandmarkFinder::kKind;
  });
  if (asks_again) {
    std::string id;  // of the report is the one that sees the pictures first
    chosen.frontal_landmarks = make<LandmarkFinder>(plugins, estimates, choice.landmarks, id);
  }
  return chosen;
}

}  // namespace armature::bench
