// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "armature/runtime/deployment_file/deployment_config.hpp"

namespace armature ARMATURE_EXPORT {

/// A fault that a drill puts into one component of a run whose arms are simulated: once the process
/// gets SIGUSR1, its next step throws, hangs or crashes.
class InjectedFault {
 public:
  enum class Kind { throws, hangs, crashes };

  /// Reads "motion:throw" (or hang, crash) and checks it against the deployment: the component is
  /// there, and every driver is `simulated: true`. Throws config::ConfigError.
  static InjectedFault read(std::string_view text, const DeploymentConfig& deployment);

  const std::string& component() const { return component_; }

  /// From here on SIGUSR1 arms the injected faults of this process instead of ending it.
  static void listen();
  /// Called before a step of the component; real-time safe while it is not armed.
  void strike_if_armed() const;

 private:
  InjectedFault(std::string component, Kind kind) : component_{std::move(component)}, kind_{kind} {}

  std::string component_;
  Kind kind_;
};

}  // namespace armature
