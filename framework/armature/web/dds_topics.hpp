// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <set>
#include <string>
#include <vector>

#include "armature/bus/fast_dds/observer.hpp"
#include "armature/bus/network.hpp"
#include "armature/runtime/plugins/plugin_registry.hpp"
#include "armature/web/topic_source.hpp"

namespace armature ARMATURE_EXPORT {

/// The topics of a DDS domain, seen by a stranger in it, who reads and does nothing else: nobody in
/// the domain waits for it.
class DdsTopics final : public TopicSource {
 public:
  /// Joins the domain with the observer among `plugins`, which outlive this. Throws PluginError
  /// with the reason when the domain cannot be joined. `on_conflict` is told once, by `topics`, of
  /// each program that writes a topic as another type than the one that is shown, and of each topic
  /// that is read anew because its writers came back with another type or less QoS.
  DdsTopics(PluginRegistry& plugins, const NetworkOptions& network,
            std::function<void(const std::string&)> on_conflict);

  /// Of a topic that is written as several types the one of the deployment that has it.
  std::vector<Topic> topics() const override;
  Schema schema_of(const Topic& topic) const override;
  /// Messages come on a thread of DDS.
  bool watch(const std::string& name, OnMessage on_message) override;
  void unwatch(const std::string& name) override;

 private:
  void tell_conflicts(const ObservedTopic& topic) const;
  /// At most a hundred, each once: `what` tells them apart.
  void tell_once(const std::string& what, const std::string& text) const;

  std::function<void(const std::string&)> on_conflict_;
  mutable std::set<std::string> told_;
  PluginPtr<DdsObserver> observer_;
};

}  // namespace armature
