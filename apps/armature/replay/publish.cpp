// SPDX-License-Identifier: Apache-2.0
#include "replay/publish.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>
#include <set>
#include <stdexcept>
#include <string>
#include <vector>

#include "armature/bus/topic_name.hpp"
#include "armature/bus/transport.hpp"
#include "armature/recording/mcap_reader.hpp"
#include "armature/recording/mcap_summary.hpp"
#include "armature/recording/recorded_processes.hpp"
#include "armature/runtime/execution/clock.hpp"
#include "armature/runtime/plugins/plugin_registry.hpp"
#include "armature/values/json_text.hpp"
#include "exit_code.hpp"
#include "replay/recorded_qos.hpp"
#include "standard_output.hpp"

namespace armature {
namespace {

/// Throws InvalidChoice when nothing was recorded so many seconds after the beginning.
void check_from(const PublishOptions& options) {
  if (options.from_s <= 0) return;
  Time first, last;
  if (const auto summary = read_summary(options.file)) {
    first = summary->first;
    last = summary->last;
  } else {
    McapReader reader{options.file};
    bool any = false;
    while (const auto message = reader.next()) {
      first = any ? std::min(first, message->log_time) : message->log_time;
      last = any ? std::max(last, message->log_time) : message->log_time;
      any = true;
    }
  }
  const double length_s = to_seconds(last - first);
  if (options.from_s <= length_s) return;
  throw InvalidChoice(fmt::format("'{}' is {:.3f} s long: nothing is there from {:g} s on",
                                  options.file.string(), length_s, options.from_s));
}

class Player {
 public:
  explicit Player(const PublishOptions& options)
      : options_{options}, processes_{recorded_processes(options.file)} {
    auto transport = plugins_.make<Transport>(
        "transport/fast_dds", TransportOptions{.network = options.network,
                                               .deployment = "a recording",
                                               .fingerprint = "",
                                               .on_event = [](const TransportEvent&) {},
                                               .now = [this] { return clock_.now(); }});
    if (!transport) throw std::runtime_error("cannot join DDS: " + transport.error().text);
    transport_ = std::move(*transport);
  }

  /// From the beginning to the end, or until it is time to leave.
  void play() {
    McapReader reader{options_.file};
    std::optional<Time> first;
    const Time start = monotonic_now();
    while (const auto message = reader.next()) {
      if (!first) first = message->log_time;
      if (is_doubled(*message->channel, processes_)) continue;
      Topic* topic = topic_of(*message->channel);
      if (!topic) continue;
      const double at_s = to_seconds(message->log_time - *first) - options_.from_s;
      // What is kept for those who come later counts from the beginning of the recording.
      if (at_s < 0 && !topic->is_latched) continue;
      const Time due = start + seconds(at_s / options_.rate);
      if (due > monotonic_now() && !wait_until(due)) return;
      if (left() || is_over()) return;
      publish(*topic, message->data);
    }
    for (const std::string& problem : reader.problems()) problems_.insert(problem);
  }

  bool is_over() const {
    return options_.timeout_s > 0 && monotonic_now() - begin_ > seconds(options_.timeout_s);
  }
  std::uint64_t messages() const { return messages_; }
  std::size_t topics() const { return topics_.size() - unknown_.size(); }
  const std::set<std::string>& unknown() const { return unknown_; }
  const std::set<std::string>& problems() const { return problems_; }

 private:
  struct Topic {
    bool is_latched = false;
    std::unique_ptr<SamplePool> pool;  // outlives the writer, which may still be sending
    std::unique_ptr<RemoteWriter> writer;
  };

  /// Null: of a type that is not known here.
  Topic* topic_of(const McapChannel& channel) {
    const auto [place, is_new] = topics_.try_emplace(channel.topic);
    Topic& topic = place->second;
    if (!is_new) return topic.writer ? &topic : nullptr;
    const auto dds_type = channel.metadata.find("dds_type");
    const MessageType* type =
        dds_type == channel.metadata.end() ? nullptr : find_message_type(dds_type->second);
    if (!type) {
      unknown_.insert(channel.topic);
      return nullptr;
    }
    const QosProfile profile = replayed_profile(channel);
    topic.is_latched = settings(profile).transient_local;
    topic.pool = std::make_unique<SamplePool>(*type, 16);
    auto writer = transport_->advertise(
        {.name = dds_topic_name(options_.prefix + channel.topic), .type = type, .qos = profile});
    if (!writer) throw std::runtime_error(writer.error().text);
    topic.writer = std::move(*writer);
    return &topic;
  }

  void publish(Topic& topic, std::span<const std::byte> cdr) {
    SampleRef sample = topic.pool->loan();
    if (!topic.pool->type().decode(cdr, sample.mutable_message())) return;
    sample.mutable_info().published = clock_.now();
    topic.writer->offer(sample);
    ++messages_;
  }

  bool wait_until(Time due) const {
    while (!is_over()) {
      const Duration left = due - monotonic_now();
      if (left <= Duration{0}) return true;
      if (!wait_for(std::min(left, seconds(0.1)))) return false;
    }
    return false;
  }

  const PublishOptions& options_;
  const std::vector<std::string> processes_;
  const Time begin_ = monotonic_now();
  SystemClock clock_;
  PluginRegistry plugins_;
  PluginPtr<Transport> transport_;
  std::map<std::string, Topic> topics_;
  std::uint64_t messages_ = 0;
  std::set<std::string> unknown_, problems_;
};

}  // namespace

int publish_recording(const PublishOptions& options) {
  check_from(options);
  leave_in_order();
  Player player{options};
  do {
    player.play();
  } while (options.loop && player.messages() > 0 && !left() && !player.is_over());
  for (const std::string& topic : player.unknown()) {
    fmt::print(stderr, "armature: '{}' is of a type that is not known here\n", topic);
  }
  for (const std::string& problem : player.problems()) {
    fmt::print(stderr, "armature: '{}': {}\n", options.file.string(), problem);
  }
  if (player.messages() == 0 && player.unknown().empty() && !left()) {
    fmt::print(stderr, "armature: '{}' has no messages to be published\n", options.file.string());
  }
  if (options.json) {
    print_out("{}\n", json_text(nlohmann::ordered_json{{"messages", player.messages()},
                                                       {"topics", player.topics()},
                                                       {"prefix", options.prefix}}));
  } else {
    print_out("{} messages of {} topics under {}\n", player.messages(), player.topics(),
              options.prefix);
  }
  return player.messages() > 0 ? kOk : kFailed;
}

}  // namespace armature
