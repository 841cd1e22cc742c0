// SPDX-License-Identifier: Apache-2.0
#pragma once

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
  /// with the reason when the domain cannot be joined.
  DdsTopics(PluginRegistry& plugins, const NetworkOptions& network);

  std::vector<Topic> topics() const override;
  Schema schema_of(const Topic& topic) const override;
  /// Messages come on a thread of DDS.
  bool watch(const std::string& name, OnMessage on_message) override;
  void unwatch(const std::string& name) override;

 private:
  PluginPtr<DdsObserver> observer_;
};

}  // namespace armature
