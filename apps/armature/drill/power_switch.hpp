// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <deque>
#include <vector>

#include "armature/bus/topic.hpp"
#include "armature/runtime/execution/clock.hpp"
#include "armature/runtime/plugins/plugin_registry.hpp"
#include "drill/drilled_deployment.hpp"

namespace armature::drill {

/// The main switch of all simulated arms' drives, outside of their deployment.
class PowerSwitch {
 public:
  /// Joins the domain, which takes the deployment some time to find out: made before it is used.
  /// Throws PluginError when the domain cannot be joined.
  PowerSwitch(PluginRegistry& plugins, const std::vector<DrilledArm>& arms, int domain);

  /// Until it is turned for the first time, the arms have power.
  void turn(bool on);

 private:
  SystemClock clock_;
  PluginPtr<Transport> transport_;
  std::deque<Topic> topics_;  // go before the transport
};

}  // namespace armature::drill
