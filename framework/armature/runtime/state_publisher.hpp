// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
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
/// armature_msgs/ComponentState and, for ROS tools, on /diagnostics. One that has missed more
/// periods than it kept for a second is degraded, and the operator is told.
class StatePublisher final : public Component {
 public:
  /// `units` outlives it and holds the components to tell about.
  StatePublisher(Setup& setup, const std::vector<std::unique_ptr<Unit>>& units);

  static const PluginManifest& manifest();
  void step(Time now) override;

 private:
  /// What was counted of a unit until the last time, and for how many times it has been late.
  struct Counted {
    std::uint64_t activations = 0, overruns = 0;
    int late = 0;
  };
  /// How the unit is, its periods since the last time included.
  Voice::Status status_of(const Unit& unit, Counted& counted);
  void publish_state(const Unit& unit, const Voice::Status& status, Time now);

  const std::vector<std::unique_ptr<Unit>>& units_;
  std::vector<Counted> counted_;  // of units_
  Output<msg::ComponentState> state_;
  Output<msg::DiagnosticArray> diagnostics_;
};

}  // namespace armature
