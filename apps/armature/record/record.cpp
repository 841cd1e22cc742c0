// SPDX-License-Identifier: Apache-2.0
#include "record/record.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <iterator>
#include <nlohmann/json.hpp>
#include <set>
#include <stdexcept>

#include "armature/bus/topic_name.hpp"
#include "armature/config/problems.hpp"
#include "armature/recording/mcap_reader.hpp"
#include "exit_code.hpp"
#include "record/recorder.hpp"

namespace armature {
namespace {

using Json = nlohmann::ordered_json;

/// `wanted`: a name, or the beginning of names and "*".
bool matches(const std::string& topic, const std::string& wanted) {
  return wanted.ends_with('*') ? topic.starts_with(wanted.substr(0, wanted.size() - 1))
                               : topic == ros_topic_name(dds_topic_name(wanted));
}

/// A recording is not lost by a word that was typed wrongly.
void refuse_to_replace(const std::filesystem::path& file, bool force) {
  std::error_code error;
  const bool has_content =
      std::filesystem::is_regular_file(file, error) && std::filesystem::file_size(file, error) > 0;
  if (!has_content || force) return;
  throw InvalidChoice(fmt::format("'{}' is there already; --force replaces it", file.string()));
}

/// A name from a file, as a terminal may be shown it.
std::string shown(std::string name) {
  std::ranges::replace_if(
      name, [](unsigned char c) { return c < ' ' || c == 0x7F; }, '?');
  return name;
}

std::string text_of(const Json& json) {
  return json.dump(-1, ' ', false, Json::error_handler_t::replace);
}

/// Watches the wanted topics, those that come up later, too.
class Topics {
 public:
  Topics(const RecordOptions& options, Recorder& recorder)
      : options_{options}, recorder_{recorder}, outsider_{options} {}

  void look() {
    for (const ObservedTopic& topic : outsider_.dds().topics()) {
      const std::string name = ros_topic_name(topic.name);
      const bool is_new = topic.writers > 0 && !watched_.contains(name);
      const bool is_wanted = options_.topics.empty() ||
                             std::ranges::any_of(options_.topics, [&](const std::string& wanted) {
                               return matches(name, wanted);
                             });
      if (!is_new || !is_wanted) continue;
      const auto watching = outsider_.dds().watch(
          topic.name, Duration{0},
          [this, name](const ObservedSample& sample) { recorder_.add(name, sample); });
      if (watching) watched_.insert(name);
    }
  }
  std::size_t count() const { return watched_.size(); }
  /// The names that were asked for and that nobody wrote.
  std::vector<std::string> missing() const {
    std::vector<std::string> missing;
    std::ranges::copy_if(options_.topics, std::back_inserter(missing), [&](const auto& wanted) {
      return std::ranges::none_of(watched_,
                                  [&](const auto& name) { return matches(name, wanted); });
    });
    return missing;
  }

 private:
  const RecordOptions& options_;
  Recorder& recorder_;
  std::set<std::string> watched_;
  Outsider outsider_;  // goes before what its callbacks use
};

std::string megabytes(std::uint64_t bytes) {
  return fmt::format("{:.3f} MB", 1e-6 * static_cast<double>(bytes));
}

void tell_dropped(const Recorder& recorder) {
  for (const auto& [topic, count] : recorder.dropped()) {
    fmt::print(stderr, "armature: {} samples of '{}' came faster than they could be written\n",
               count, topic);
  }
}

struct TopicCount {
  std::string type;
  std::uint64_t messages = 0, bytes = 0;
  Time first, last;  // when they arrived
  Time sent_first, sent_last;

  double hz() const {
    const double length = to_seconds(sent_last - sent_first);
    return length > 0 ? static_cast<double>(messages - 1) / length : 0;
  }
};

std::map<std::string, TopicCount> count_topics(McapReader& reader) {
  std::map<std::string, TopicCount> topics;
  while (const auto message = reader.next()) {
    TopicCount& topic = topics[message->channel->topic];
    if (topic.messages++ == 0) {
      topic.first = message->log_time;
      topic.sent_first = message->publish_time;
    }
    topic.last = std::max(topic.last, message->log_time);
    topic.sent_last = std::max(topic.sent_last, message->publish_time);
    topic.bytes += message->data.size();
  }
  for (const auto& [id, channel] : reader.channels()) {
    const auto schema = reader.schemas().find(channel.schema_id);
    topics[channel.topic].type = schema == reader.schemas().end() ? "?" : schema->second.name;
  }
  return topics;
}

/// [s] from the first message of all topics to the last.
double length_of(const std::map<std::string, TopicCount>& topics) {
  Time first, last;
  bool any = false;
  for (const auto& [name, topic] : topics) {
    if (topic.messages == 0) continue;
    first = any ? std::min(first, topic.first) : topic.first;
    last = any ? std::max(last, topic.last) : topic.last;
    any = true;
  }
  return to_seconds(last - first);
}

Json json_of(const McapReader& reader, const std::map<std::string, TopicCount>& topics) {
  Json json{{"library", reader.library()},
            {"whole", reader.problems().empty()},
            {"problems", reader.problems()},
            {"length_s", length_of(topics)},
            {"chunks", reader.chunks()},
            {"packed_bytes", reader.packed_bytes()},
            {"unpacked_bytes", reader.unpacked_bytes()},
            {"topics", Json::array()},
            {"attachments", Json::array()},
            {"metadata", Json::array()}};
  for (const auto& [name, topic] : topics) {
    json["topics"].push_back({{"topic", name},
                              {"type", topic.type},
                              {"messages", topic.messages},
                              {"bytes", topic.bytes}});
  }
  for (const McapAttachment& attachment : reader.attachments()) {
    json["attachments"].push_back({{"name", attachment.name}, {"bytes", attachment.data.size()}});
  }
  for (const McapMetadata& metadata : reader.metadata()) {
    json["metadata"].push_back({{"name", metadata.name}, {"values", metadata.values}});
  }
  return json;
}

void print(const McapReader& reader, const std::map<std::string, TopicCount>& topics) {
  fmt::print("{:.3f} s by {}, {} in {} chunks, {} unpacked\n", length_of(topics), reader.library(),
             megabytes(reader.packed_bytes()), reader.chunks(), megabytes(reader.unpacked_bytes()));
  std::size_t width = 0;
  for (const auto& [name, topic] : topics) width = std::max(width, name.size());
  for (const auto& [name, topic] : topics) {
    fmt::print("  {:<{}}  {:<40} {:>9} messages {:>9.1f} Hz {:>14}\n", shown(name), width,
               shown(topic.type), topic.messages, topic.hz(), megabytes(topic.bytes));
  }
  for (const McapAttachment& attachment : reader.attachments()) {
    fmt::print("  attached: {}, {} bytes\n", shown(attachment.name), attachment.data.size());
  }
  for (const McapMetadata& metadata : reader.metadata()) {
    fmt::print("  {}:", shown(metadata.name));
    for (const auto& [key, value] : metadata.values) {
      fmt::print(" {}={}", shown(key), shown(value));
    }
    fmt::print("\n");
  }
}

}  // namespace

int record_topics(const RecordOptions& options) {
  leave_in_order();
  refuse_to_replace(options.out, options.force);
  Recorder recorder{options.out, options.compress};
  const Time start = monotonic_now();
  std::vector<std::string> missing;
  {
    Topics topics{options, recorder};
    bool told = false;
    while (!left() && recorder.problem().empty()) {
      topics.look();
      const Duration waited = monotonic_now() - start;
      if (options.timeout_s > 0 && waited > seconds(options.timeout_s)) break;
      if (!told && waited > kDiscovery && topics.count() == 0) {
        told = true;
        fmt::print(stderr, "armature: none of the topics is written in domain {} yet, waiting\n",
                   options.network.domain);
      }
      wait_for(seconds(0.05));
    }
    missing = topics.missing();
  }
  for (const std::string& topic : missing) {
    fmt::print(stderr, "armature: nobody wrote {}\n", config::in_quotes(topic));
  }
  tell_dropped(recorder);
  try {
    recorder.close();
  } catch (const std::runtime_error& error) {
    if (recorder.messages() == 0) throw;
    throw std::runtime_error(fmt::format(
        "{}; what was written before is readable, and made whole by: armature record --repair {} "
        "-o whole.mcap",
        error.what(), options.out.string()));
  }
  if (options.json) {
    std::uint64_t dropped = 0;
    for (const auto& [topic, count] : recorder.dropped()) dropped += count;
    fmt::print("{}\n", Json{{"file", options.out.string()},
                            {"topics", recorder.topics()},
                            {"messages", recorder.messages()},
                            {"bytes", recorder.bytes()},
                            {"dropped", dropped}}
                           .dump());
  } else {
    fmt::print("{}: {} messages of {} topics, {}\n", options.out.string(), recorder.messages(),
               recorder.topics(), megabytes(recorder.bytes()));
  }
  if (recorder.messages() > 0) return kOk;
  fmt::print(stderr, "armature: nothing came to be recorded\n");
  return kTimedOut;
}

int repair_recording(const std::filesystem::path& cut, const std::filesystem::path& whole,
                     bool force) {
  std::error_code error;
  if (std::filesystem::equivalent(cut, whole, error)) {
    throw InvalidChoice(fmt::format("'{}' cannot be repaired in place: -o OTHER", cut.string()));
  }
  refuse_to_replace(whole, force);
  McapReader reader{cut};
  McapWriter writer{whole, {.library = "armature " ARMATURE_VERSION}};
  std::map<std::uint16_t, std::uint16_t> schemas, channels;  // ids there by ids here
  schemas[0] = 0;
  while (const auto message = reader.next()) {
    const McapChannel& channel = *message->channel;
    if (!channels.contains(channel.id)) {
      const auto schema = reader.schemas().find(channel.schema_id);
      if (!schemas.contains(channel.schema_id) && schema != reader.schemas().end()) {
        schemas[channel.schema_id] = writer.add(schema->second);
      }
      McapChannel copy = channel;
      copy.schema_id = schemas[channel.schema_id];
      channels[channel.id] = writer.add(copy);
    }
    writer.write(channels[channel.id], message->sequence, message->log_time, message->publish_time,
                 message->data);
  }
  for (const McapAttachment& attachment : reader.attachments()) writer.attach(attachment);
  for (const McapMetadata& metadata : reader.metadata()) writer.add(metadata);
  writer.close();
  for (const std::string& problem : reader.problems()) {
    fmt::print(stderr, "armature: '{}': {}\n", cut.string(), problem);
  }
  fmt::print("{}: {} messages{}\n", whole.string(), writer.messages(),
             reader.problems().empty() ? ", all of a file that was whole" : "");
  return kOk;
}

int describe_recording(const std::filesystem::path& file, bool json) {
  McapReader reader{file};
  const auto topics = count_topics(reader);
  if (json) {
    fmt::print("{}\n", text_of(json_of(reader, topics)));
  } else {
    print(reader, topics);
  }
  if (reader.problems().empty()) return kOk;
  for (const std::string& problem : reader.problems()) {
    fmt::print(stderr, "armature: '{}' is not whole: {}\n", file.string(), problem);
  }
  fmt::print(stderr,
             "armature: what can be read of it is saved by: armature record --repair {} -o "
             "whole.mcap\n",
             file.string());
  return kFailed;
}

}  // namespace armature
