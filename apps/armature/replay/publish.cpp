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
#include <string_view>
#include <utility>
#include <vector>

#include "armature/bus/topic_name.hpp"
#include "armature/bus/transport.hpp"
#include "armature/config/problems.hpp"
#include "armature/recording/mcap_reader.hpp"
#include "armature/recording/mcap_summary.hpp"
#include "armature/recording/recorded_processes.hpp"
#include "armature/runtime/execution/clock.hpp"
#include "armature/runtime/plugins/described_messages.hpp"
#include "armature/runtime/plugins/plugin_registry.hpp"
#include "armature/values/json_text.hpp"
#include "armature/values/monotonic_now.hpp"
#include "exit_code.hpp"
#include "replay/recorded_qos.hpp"
#include "standard_output.hpp"
#include "terminal_text.hpp"

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

/// What the messages of a channel are, whose schema has the name `schema`; nullptr: unknown. Only
/// Armature writes the name of DDS; others write that of ROS 2, "std_msgs/msg/Float64".
const MessageType* type_of(const McapChannel& channel, std::string schema) {
  const auto dds_type = channel.metadata.find("dds_type");
  if (dds_type != channel.metadata.end()) return find_message_type(dds_type->second);
  if (channel.message_encoding != "cdr") return nullptr;
  constexpr std::string_view kMiddle = "/msg/";
  if (const std::size_t at = schema.find(kMiddle); at != std::string::npos) {
    schema.replace(at, kMiddle.size(), "/");
  }
  return find_message_type(schema);
}

class Player {
 public:
  explicit Player(const PublishOptions& options) : options_{options}, copies_{options.file} {
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
      if (copies_.has(*message)) continue;
      Topic* topic = topic_of(*message->channel, reader);
      if (!topic) continue;
      const double at_s = to_seconds(message->log_time - *first) - options_.from_s;
      // What is kept for those who come later counts from the beginning of the recording.
      if (at_s < 0 && !topic->is_latched) continue;
      const Time due = start + seconds(at_s / options_.rate);
      tell_gap(due - monotonic_now());
      if (due > monotonic_now() && !wait_until(due)) return;
      if (left() || is_over()) return;
      publish(*topic, message->data);
    }
    for (const std::string& problem : reader.problems()) problems_.insert(problem);
  }

  /// Whether all messages of known types were published that came up.
  bool is_whole() const { return broken_.empty() && !is_partial_; }
  bool is_over() const {
    return options_.timeout_s > 0 && monotonic_now() - begin_ > seconds(options_.timeout_s);
  }
  std::uint64_t messages() const { return messages_; }
  std::size_t topics() const { return topics_.size(); }
  /// The topics and messages that are not published, with the reason.
  const std::set<std::string>& left_out() const { return left_out_; }
  /// Messages that are not what their type says, by topic.
  const std::map<std::string, std::uint64_t>& broken() const { return broken_; }
  const std::set<std::string>& problems() const { return problems_; }

 private:
  struct Topic {
    std::string name;
    bool is_latched = false;
    std::unique_ptr<SamplePool> pool;  // outlives the writer, which may still be sending
    std::unique_ptr<RemoteWriter> writer;
  };

  /// Null: it is left out.
  Topic* topic_of(const McapChannel& channel, const McapReader& reader) {
    const auto [known, is_new] = by_channel_.try_emplace(channel.id, nullptr);
    if (is_new) known->second = find_topic(channel, reader);
    return known->second;
  }

  Topic* find_topic(const McapChannel& channel, const McapReader& reader) {
    const auto schema = reader.schemas().find(channel.schema_id);
    const std::string said = schema == reader.schemas().end() ? "" : schema->second.name;
    const MessageType* type = type_of(channel, said);
    if (!type) {
      const std::string name = said.substr(said.rfind('/') + 1);
      for (std::string& problem : load_messages(plugins_, name)) {
        left_out_.insert(std::move(problem));
      }
      type = type_of(channel, said);
    }
    if (!type) {
      left_out_.insert(
          fmt::format("{} is of the type {}, which is not known here, and is not "
                      "published; --monitor shows it. The folder of a library that has the type "
                      "belongs into ARMATURE_PLUGIN_PATH",
                      config::in_quotes(channel.topic), config::in_quotes(said)));
      return nullptr;
    }
    if (const auto place = topics_.find(channel.topic); place != topics_.end()) {
      if (&place->second.pool->type() == type) return &place->second;
      left_out_.insert(fmt::format("{} has messages of two types: those of {} are not published",
                                   config::in_quotes(channel.topic),
                                   config::in_quotes(type->ros_name)));
      is_partial_ = true;
      return nullptr;
    }
    Topic& topic = topics_[channel.topic];
    topic.name = channel.topic;
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
    if (!topic.pool->type().decode(cdr, sample.mutable_message())) {
      ++broken_[topic.name];
      return;
    }
    sample.mutable_info().published = clock_.now();
    topic.writer->offer(sample);
    ++messages_;
  }

  void tell_gap(Duration left) const {
    constexpr double kLong_s = 5;
    if (to_seconds(left) < kLong_s) return;
    fmt::print(
        stderr,
        "armature: the next message comes in {:.0f} s: none was recorded for {:.3g} s; a higher "
        "--rate makes it shorter\n",
        to_seconds(left), to_seconds(left) * options_.rate);
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
  const RecordedCopies copies_;
  const Time begin_ = monotonic_now();
  SystemClock clock_;
  PluginRegistry plugins_;
  PluginPtr<Transport> transport_;
  std::map<std::string, Topic> topics_;
  std::map<std::uint16_t, Topic*> by_channel_;
  std::uint64_t messages_ = 0;
  std::map<std::string, std::uint64_t> broken_;
  std::set<std::string> left_out_, problems_;
  bool is_partial_ = false;
};

}  // namespace

int publish_recording(const PublishOptions& options) {
  check_from(options);
  leave_in_order();
  Player player{options};
  do {
    player.play();
  } while (options.loop && player.messages() > 0 && !left() && !player.is_over());
  for (const std::string& text : player.left_out()) {
    fmt::print(stderr, "armature: {}\n", terminal_text(text));
  }
  for (const auto& [topic, count] : player.broken()) {
    fmt::print(stderr, "armature: {} messages of {} are not what their type says\n", count,
               terminal_text(config::in_quotes(topic)));
  }
  for (const std::string& problem : player.problems()) {
    fmt::print(stderr, "armature: '{}': {}\n", options.file.string(), terminal_text(problem));
  }
  if (player.messages() == 0 && player.left_out().empty() && player.broken().empty() && !left()) {
    fmt::print(stderr, "armature: {}\n",
               player.is_over()
                   ? "the time (--timeout) was over before the first message came up"
                   : fmt::format("'{}' has no messages to be published", options.file.string()));
  }
  if (options.json) {
    print_out("{}\n", json_text(nlohmann::ordered_json{{"messages", player.messages()},
                                                       {"topics", player.topics()},
                                                       {"left_out", player.left_out()},
                                                       {"prefix", options.prefix}}));
  } else {
    print_out("{} messages of {} topics under {}\n", player.messages(), player.topics(),
              options.prefix);
  }
  return player.messages() > 0 && player.is_whole() ? kOk : kFailed;
}

}  // namespace armature
