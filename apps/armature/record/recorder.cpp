// SPDX-License-Identifier: Apache-2.0
#include "record/recorder.hpp"

#include <utility>

#include "armature/bus/qos.hpp"
#include "armature/messages/armature_msgs.hpp"
#include "armature/messages/rcl_interfaces.hpp"
#include "armature/runtime/execution/clock.hpp"
#include "armature/runtime/recording/recorded_description.hpp"

namespace armature {

Recorder::Recorder(const std::filesystem::path& file, bool compress)
    : queue_{file,
             {.library = "armature " ARMATURE_VERSION, .compress = compress},
             McapQueue::WhenFull::drop} {}

void Recorder::add(const std::string& topic, const ObservedSample& sample) {
  const Time now = SystemClock{}.now();
  const std::scoped_lock lock{mutex_};
  if (sample.lost_before > 0) lost_[topic] += sample.lost_before;
  Channel& channel = channel_of(topic, sample);
  queue_.write(channel.id, ++channel.messages, now, sample.source,
               {sample.cdr.begin(), sample.cdr.end()});
  if (sample.type == message_type<msg::DeploymentDescription>().dds_name) attach_new(sample, now);
}

Recorder::Channel& Recorder::channel_of(const std::string& topic, const ObservedSample& sample) {
  const auto [place, is_new] = channels_.try_emplace({topic, sample.type});
  if (!is_new) return place->second;
  std::map<std::string, std::string> metadata;
  if (sample.writer && sample.writer->transient_local) {
    const bool is_log = sample.type == message_type<msg::Log>().dds_name;
    metadata["qos"] = to_string(is_log ? QosProfile::log : QosProfile::latched);
  }
  place->second.id = queue_.add_channel(topic, sample.type, std::move(metadata));
  return place->second;
}

void Recorder::attach_new(const ObservedSample& description, Time arrived) {
  msg::DeploymentDescription told;
  const std::vector<std::byte> cdr{description.cdr.begin(), description.cdr.end()};
  if (!message_type<msg::DeploymentDescription>().decode(cdr, &told)) return;
  // All processes of a run tell the same files.
  if (!attached_.insert(told.deployment_() + " " + told.run_()).second) return;
  attach_description(told, arrived, queue_);
}

std::uint64_t Recorder::unwritten() const {
  const std::scoped_lock lock{mutex_};
  std::uint64_t unwritten = 0;
  for (const auto& [key, channel] : channels_) unwritten += channel.messages;
  for (const auto& [channel, count] : queue_.dropped()) unwritten -= count;
  return unwritten - queue_.messages();
}

std::size_t Recorder::topics() const {
  const std::scoped_lock lock{mutex_};
  std::set<std::string> topics;
  for (const auto& [key, channel] : channels_) topics.insert(key.first);
  return topics.size();
}

std::map<std::string, std::uint64_t> Recorder::lost() const {
  const std::scoped_lock lock{mutex_};
  return lost_;
}

std::map<std::string, std::uint64_t> Recorder::dropped() const {
  const std::scoped_lock lock{mutex_};
  const auto by_channel = queue_.dropped();
  std::map<std::string, std::uint64_t> dropped;
  for (const auto& [key, channel] : channels_) {
    const auto found = by_channel.find(channel.id);
    if (found != by_channel.end()) dropped[key.first] += found->second;
  }
  return dropped;
}

}  // namespace armature
