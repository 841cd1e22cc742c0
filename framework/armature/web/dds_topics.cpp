// SPDX-License-Identifier: Apache-2.0
#include "armature/web/dds_topics.hpp"

#include <utility>

#include "armature/bus/topic_name.hpp"
#include "armature/messages/known_types.hpp"
#include "armature/messages/ros_definition.hpp"

namespace armature {

DdsTopics::DdsTopics(PluginRegistry& plugins, const NetworkOptions& network) {
  auto observer =
      plugins.make<DdsObserver>("observer/fast_dds", ObserverOptions{.network = network});
  if (!observer) throw PluginError(observer.error().text);
  observer_ = std::move(*observer);
}

std::vector<TopicSource::Topic> DdsTopics::topics() const {
  constexpr std::size_t kKept = 100;  // of a latched topic, as DDS keeps them
  std::vector<Topic> topics;
  for (const ObservedTopic& topic : observer_->topics()) {
    const bool is_known = topic.types.size() == 1 && describe_type(topic.types.front());
    if (topic.writers == 0 || !is_known) continue;
    topics.push_back({.name = ros_topic_name(topic.name),
                      .type = topic.types.front(),
                      .keeps = topic.endpoints.front().transient_local ? kKept : 0});
  }
  return topics;
}

TopicSource::Schema DdsTopics::schema_of(const Topic& topic) const {
  const TypeDescription& type = *describe_type(topic.type);
  return {.name = ros2_name(type), .text = ros_definition(type)};
}

bool DdsTopics::watch(const std::string& name, OnMessage on_message) {
  const auto watching = observer_->watch(
      name, Duration{0}, [on_message = std::move(on_message)](const ObservedSample& sample) {
        on_message({.time = sample.source, .cdr = sample.cdr, .lost_before = sample.lost_before});
      });
  return watching.has_value();
}

void DdsTopics::unwatch(const std::string& name) { observer_->unwatch(name); }

}  // namespace armature
