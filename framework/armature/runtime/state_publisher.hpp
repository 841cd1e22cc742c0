// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <memory>
#include <vector>

#include "armature/messages/armature_msgs.hpp"
#include "armature/messages/diagnostic_msgs.hpp"
#include "armature/runtime/component.hpp"
#include "armature/runtime/plugin_manifest.hpp"
#include "armature/runtime/ports.hpp"
#include "armature/runtime/unit.hpp"

namespace armature {

/// The runtime's own component in every process: tells twice a second how each component is, as
/// armature_msgs/ComponentState and, for ROS tools, on /diagnostics.
class StatePublisher final : public Component {
 public:
  /// `units` outlives it and holds the components to tell about.
  StatePublisher(Setup& setup, const std::vector<std::unique_ptr<Unit>>& units);

  static const PluginManifest& manifest();
  void step(Time now) override;

 private:
  void publish_state(const Unit& unit, Time now);

  const std::vector<std::unique_ptr<Unit>>& units_;
  Output<msg::ComponentState> state_;
  Output<msg::DiagnosticArray> diagnostics_;
};

}  // namespace armature
