// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "armature/bus/topic.hpp"
#include "armature/bus/transport.hpp"
#include "armature/runtime/deployment/common_start.hpp"
#include "armature/runtime/deployment_file/deployment_config.hpp"
#include "armature/runtime/plugins/plugin_library.hpp"

namespace armature ARMATURE_EXPORT {

/// The topics of one process of a deployment, seen from outside: writers for its outputs, readers
/// only for inputs that another process feeds or that are open, and whether the deployment's other
/// processes have met them.
class RemoteTopics {
 public:
  RemoteTopics(PluginPtr<Transport> transport, const DeploymentConfig& deployment,
               std::string process)
      : transport_{std::move(transport)}, deployment_{&deployment}, process_{std::move(process)} {}

  /// Throws PluginError with the transport's reason.
  void advertise(const PortBinding& output, Topic& topic);
  void subscribe(const PortBinding& input, Topic& topic);
  /// No main process starts this one and the others that it exchanges topics with: they begin
  /// together. After its topics. Throws PluginError.
  void start_together();
  /// Which topic waits for which other process, if any does, at `now`: "topic
  /// '/lamp/arm/measured_js' of process 'main' has not met process 'arm'".
  std::optional<std::string> waiting(Time now);
  /// What strangers wrote to inputs that are the deployment's own, a sentence for each.
  std::vector<std::string> refusals() const;
  Transport& transport() { return *transport_; }
  /// No sample is delivered afterwards. Writers stay with their topics, which go before this.
  void stop_reading() { readers_.clear(); }

 private:
  std::string text_of(const std::string& topic, const std::set<std::string>& processes) const;
  /// The readers that other processes have for `topic`, by their process: one for all inputs that
  /// take samples of the deployment only, and one for those that are open.
  std::set<std::pair<std::string, bool>> readers_elsewhere(const std::string& topic) const;

  PluginPtr<Transport> transport_;
  const DeploymentConfig* deployment_;
  std::string process_;
  std::map<std::pair<std::string, Sources>, std::unique_ptr<RemoteReader>> readers_;
  /// A topic that another process reads or writes.
  struct Link {
    std::string text;  // that it waits
    std::function<bool()> met;
  };
  std::vector<Link> links_;
  std::optional<CommonStart> common_start_;
};

}  // namespace armature
