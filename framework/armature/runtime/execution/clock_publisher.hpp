// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "armature/messages/rosgraph_msgs.hpp"
#include "armature/runtime/component/component.hpp"
#include "armature/runtime/component/ports.hpp"
#include "armature/runtime/execution/rate_limiter.hpp"
#include "armature/runtime/plugins/plugin_manifest.hpp"

namespace armature {

/// The runtime's own component on the simulated clock: tells the time on /clock, a hundred times in
/// a simulated second, so that ROS nodes with `use_sim_time` live in the time of our stamps.
class ClockPublisher final : public Component {
 public:
  explicit ClockPublisher(Setup& setup);

  static const PluginManifest& manifest();
  void step(Time now) override;

 private:
  RateLimiter rate_limiter_;
  Output<msg::Clock> clock_;
};

}  // namespace armature
