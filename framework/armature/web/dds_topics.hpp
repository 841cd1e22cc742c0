// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <mutex>
#include <set>
#include <string>
#include <vector>

#include "armature/bus/fast_dds/observer.hpp"
#include "armature/bus/network.hpp"
#include "armature/runtime/plugins/plugin_registry.hpp"
#include "armature/web/told_once.hpp"
#include "armature/web/topic_source.hpp"

namespace armature ARMATURE_EXPORT {

/// The topics of a DDS domain, seen by a stranger in it, who reads and does nothing else: nobody in
/// the domain waits for it.
class DdsTopics final : public TopicSource {
 public:
  /// Joins the domain with the observer among `plugins`, which outlive this. Throws PluginError
  /// with the reason when the domain cannot be joined. `on_conflict` is told once, by `topics`, of
  /// each program that writes a topic as another type than the one that is shown, or with less QoS,
  /// and is not heard, of each topic that is read anew because it is written with another type or
  /// less QoS now, and of each program that speaks in the name of a deployment that it is no part
  /// of.
  DdsTopics(PluginRegistry& plugins, const NetworkOptions& network,
            std::function<void(const std::string&)> on_conflict);

  /// Of a topic that is written as several types the one of the deployment that has it. The
  /// description of a deployment that nobody of it writes is none.
  std::vector<Topic> topics() const override;
  Schema schema_of(const Topic& topic) const override;
  /// Messages come on a thread of DDS. What a deployment consists of, how it is, and lines of
  /// /rosout in its name are taken from it only, as long as it is there.
  bool watch(const std::string& name, OnMessage on_message) override;
  void unwatch(const std::string& name) override;

 private:
  /// On a thread of DDS.
  bool is_believed(const std::string& topic, const ObservedSample& sample) const;
  std::set<std::string> take_not_believed() const;
  void tell_unheard(const ObservedTopic& topic) const;
  /// `what` tells them apart.
  void tell_once(const std::string& what, const std::string& text) const;

  std::function<void(const std::string&)> on_conflict_;
  mutable ToldOnce told_;
  mutable std::mutex mutex_;
  mutable std::set<std::string> deployments_;   // that are there
  mutable std::set<std::string> not_believed_;  // what is to be told of whom
  PluginPtr<DdsObserver> observer_;
};

}  // namespace armature
