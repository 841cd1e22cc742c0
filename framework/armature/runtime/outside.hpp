// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "armature/bus/topic.hpp"
#include "armature/bus/transport.hpp"
#include "armature/runtime/deployment_config.hpp"
#include "armature/runtime/plugin_library.hpp"

namespace armature {

/// The topics of one process of a deployment, seen from outside: writers for its outputs, readers
/// only for inputs that another process feeds, and whether the deployment's other processes have
/// met them.
class Outside {
 public:
  Outside(PluginPtr<Transport> transport, const DeploymentConfig& deployment, std::string process)
      : transport_{std::move(transport)}, deployment_{&deployment}, process_{std::move(process)} {}

  /// Throws PluginError with the transport's reason.
  void advertise(const PortBinding& output, Topic& topic);
  void subscribe(const PortBinding& input, Topic& topic);
  /// A topic that waits for another process, if any does.
  std::optional<std::string> waiting() const;
  /// No sample is delivered afterwards. Writers stay with their topics, which go before this.
  void stop_reading() { readers_.clear(); }

 private:
  /// How many other processes read `topic`: a process does it once for all of its components.
  int readers_elsewhere(const std::string& topic) const;
  /// How many components of other processes write `topic`.
  int writers_elsewhere(const std::string& topic) const;

  PluginPtr<Transport> transport_;
  const DeploymentConfig* deployment_;
  std::string process_;
  std::map<std::string, std::unique_ptr<OutsideReader>> readers_;  // by topic
  /// A topic that another process reads or writes.
  struct Link {
    std::string topic;
    std::function<bool()> met;
  };
  std::vector<Link> links_;
};

}  // namespace armature
