// SPDX-License-Identifier: Apache-2.0
#include "armature/web/dds_topics.hpp"

#include <fmt/format.h>

#include <utility>

#include "armature/bus/topic_name.hpp"
#include "armature/messages/armature_msgs.hpp"
#include "armature/messages/known_types.hpp"
#include "armature/messages/rcl_interfaces.hpp"
#include "armature/messages/ros_definition.hpp"

namespace armature {
namespace {

/// The deployment that tells on this topic what it consists of or how it is; empty: it is another
/// topic.
std::string teller_of(const std::string& dds_topic, const std::string& type) {
  if (type == message_type<msg::DeploymentDescription>().dds_name) {
    return deployment_of(dds_topic, "description");
  }
  if (type == message_type<msg::ComponentStates>().dds_name) {
    return deployment_of(dds_topic, "component_states");
  }
  return "";
}

/// "lamp" of a line of "lamp.task", or of "lamp".
std::string speaker_of(const ObservedSample& sample) {
  msg::Log line;
  const MessageType& type = message_type<msg::Log>();
  if (sample.type != type.dds_name || !type.decode(sample.cdr, &line)) return "";
  return line.name_().substr(0, line.name_().find('.'));
}

std::string not_believed(const ObservedEndpoint& writer, const std::string& topic,
                         const std::string& deployment) {
  return fmt::format(
      "a writer of {} writes '{}' in the name of deployment '{}' and is no part of "
      "it: that is not shown",
      writer.owner, topic, deployment);
}

}  // namespace

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
    tell_once(
        topic,
        fmt::format("'{}' is written with another type or less QoS now: it is read anew", name));
  }
  for (const std::string& line : take_not_believed()) tell_once(line, line);
  std::vector<Topic> topics;
  std::set<std::string> deployments;
  for (const ObservedTopic& topic : observer_->topics()) {
    deployments.insert(topic.deployments.begin(), topic.deployments.end());
    if (topic.writers == 0) continue;
    const ObservedEndpoint& read = topic.endpoints.front();
    const bool is_sure = topic.types.size() == 1 || !read.deployment.empty();
    if (!is_sure || !describe_type(read.type)) continue;
    const std::string teller = teller_of(topic.name, read.type);
    if (!teller.empty() && teller != read.deployment) {
      const std::string line = not_believed(read, ros_topic_name(topic.name), teller);
      tell_once(line, line);
      continue;
    }
    tell_unheard(topic);
    topics.push_back({.name = ros_topic_name(topic.name),
                      .type = read.type,
                      .keeps = read.transient_local ? kKept : 0});
  }
  const std::scoped_lock lock{mutex_};
  deployments_ = std::move(deployments);
  return topics;
}

std::set<std::string> DdsTopics::take_not_believed() const {
  const std::scoped_lock lock{mutex_};
  return std::exchange(not_believed_, {});
}

bool DdsTopics::is_believed(const std::string& topic, const ObservedSample& sample) const {
  constexpr std::size_t kMostAtOnce = 100;
  const std::string teller = teller_of(dds_topic_name(topic), sample.type);
  const std::string name = teller.empty() && topic == "/rosout" ? speaker_of(sample) : teller;
  if (name.empty() || (sample.writer && sample.writer->deployment == name)) return true;
  const std::scoped_lock lock{mutex_};
  if (teller.empty() && (!sample.writer || !deployments_.contains(name))) return true;
  if (sample.writer && not_believed_.size() < kMostAtOnce) {
    not_believed_.insert(not_believed(*sample.writer, topic, name));
  }
  return false;
}

void DdsTopics::tell_unheard(const ObservedTopic& topic) const {
  const std::string& shown = topic.endpoints.front().type;
  for (const ObservedEndpoint& writer : topic.endpoints) {
    if (!writer.writes || writer.is_heard) continue;
    const std::string how = writer.type == shown
                                ? "with less QoS than the writer that is shown"
                                : fmt::format("as {}: it is shown as {}", writer.type, shown);
    tell_once(writer.owner + " " + topic.name,
              fmt::format("a writer of {} writes '{}', too, {}, and what that one writes is not",
                          writer.owner, ros_topic_name(topic.name), how));
  }
}

void DdsTopics::tell_once(const std::string& what, const std::string& text) const {
  if (told_.is_new(what)) on_conflict_(text);
}

TopicSource::Schema DdsTopics::schema_of(const Topic& topic) const {
  const TypeDescription& type = *describe_type(topic.type);
  return {.name = ros2_name(type), .text = ros_definition(type)};
}

bool DdsTopics::watch(const std::string& name, OnMessage on_message) {
  const auto watching = observer_->watch(
      name, Duration{0},
      [this, name, on_message = std::move(on_message)](const ObservedSample& sample) {
        if (!is_believed(name, sample)) return;
        on_message({.time = sample.source, .cdr = sample.cdr, .lost_before = sample.lost_before});
      });
  return watching.has_value();
}

void DdsTopics::unwatch(const std::string& name) { observer_->unwatch(name); }

}  // namespace armature
