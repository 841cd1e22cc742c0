// SPDX-License-Identifier: Apache-2.0
#include "armature/web/dds_topics.hpp"

#include <fmt/format.h>

#include <utility>

#include "armature/bus/topic_name.hpp"
#include "armature/messages/known_types.hpp"
#include "armature/messages/ros_definition.hpp"

namespace armature {

DdsTopics::DdsTopics(PluginRegistry& plugins, const NetworkOptions& network,
                     std::function<void(const std::string&)> on_conflict)
    : on_conflict_{std::move(on_conflict)} {
  auto observer =
      plugins.make<DdsObserver>("observer/fast_dds", ObserverOptions{.network = network});
  if (!observer) throw PluginError(observer.error().text);
  observer_ = std::move(*observer);
}

std::vector<TopicSource::Topic> DdsTopics::topics() const {
  constexpr std::size_t kKept = 100;  // of a latched topic, as DDS keeps them
  for (const std::string& topic : observer_->watch_again()) {
    const std::string name = ros_topic_name(topic);
    tell_once(topic,
              fmt::format("'{}' came back with another type or less QoS: it is read anew", name));
  }
  std::vector<Topic> topics;
  for (const ObservedTopic& topic : observer_->topics()) {
    if (topic.writers == 0) continue;
    const ObservedEndpoint& read = topic.endpoints.front();
    const bool is_sure = topic.types.size() == 1 || !read.deployment.empty();
    if (!is_sure || !describe_type(read.type)) continue;
    tell_conflicts(topic);
    topics.push_back({.name = ros_topic_name(topic.name),
                      .type = read.type,
                      .keeps = read.transient_local ? kKept : 0});
  }
  return topics;
}

void DdsTopics::tell_conflicts(const ObservedTopic& topic) const {
  const std::string& shown = topic.endpoints.front().type;
  for (const ObservedEndpoint& endpoint : topic.endpoints) {
    if (!endpoint.writes || endpoint.type == shown) continue;
    tell_once(endpoint.owner + " " + topic.name,
              fmt::format("a writer of {} writes '{}', too, as {}: it is shown as {}, and what "
                          "that one writes is not",
                          endpoint.owner, ros_topic_name(topic.name), endpoint.type, shown));
  }
}

void DdsTopics::tell_once(const std::string& what, const std::string& text) const {
  constexpr std::size_t kMostTold = 100;
  if (told_.size() < kMostTold && told_.insert(what).second) on_conflict_(text);
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
