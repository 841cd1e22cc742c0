// SPDX-License-Identifier: Apache-2.0
#include "record/record.hpp"

#include <fmt/chrono.h>
#include <fmt/format.h>

#include <algorithm>
#include <ctime>
#include <iterator>
#include <nlohmann/json.hpp>
#include <optional>
#include <set>
#include <stdexcept>
#include <utility>

#include "armature/bus/topic_name.hpp"
#include "armature/config/problems.hpp"
#include "armature/recording/hash_chain.hpp"
#include "armature/recording/mcap_reader.hpp"
#include "armature/recording/mcap_summary.hpp"
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

void tell_lost(const Recorder& recorder) {
  for (const auto& [topic, count] : recorder.dropped()) {
    fmt::print(stderr, "armature: {} samples of '{}' came faster than they could be written\n",
               count, topic);
  }
  for (const auto& [topic, count] : recorder.lost()) {
    fmt::print(stderr, "armature: {} samples of '{}' did not arrive\n", count, topic);
  }
}

struct TopicCount {
  std::string type;
  std::uint64_t messages = 0;
  std::optional<std::uint64_t> bytes;  // a summary does not tell
  double hz = 0;
};

/// What is told of a recording, wherever it was read.
struct Contents {
  std::string library;
  Duration length{0};
  std::uint64_t chunks = 0, packed_bytes = 0, unpacked_bytes = 0;
  std::map<std::string, TopicCount> topics;
  std::vector<McapSummary::Attachment> attachments;
  std::vector<McapMetadata> metadata;
  std::uint64_t links = 0;  // of the chain of hashes, as the summary says
  std::string head;
};

double rate(std::uint64_t messages, Duration length) {
  const double length_s = to_seconds(length);
  return messages > 1 && length_s > 0 ? static_cast<double>(messages - 1) / length_s : 0;
}

std::string type_of(const McapChannel& channel,
                    const std::map<std::uint16_t, McapSchema>& schemas) {
  const auto schema = schemas.find(channel.schema_id);
  return schema == schemas.end() ? "?" : schema->second.name;
}

Contents contents_of(const McapSummary& summary) {
  Contents contents{.library = summary.library,
                    .length = summary.last - summary.first,
                    .chunks = summary.chunks,
                    .packed_bytes = summary.packed_bytes,
                    .unpacked_bytes = summary.unpacked_bytes,
                    .topics = {},
                    .attachments = summary.attachments,
                    .metadata = summary.metadata,
                    .links = summary.links,
                    .head = summary.head};
  for (const auto& [id, channel] : summary.channels) {
    TopicCount& topic = contents.topics[channel.topic];
    topic.type = type_of(channel, summary.schemas);
    const auto messages = summary.messages.find(id);
    if (messages != summary.messages.end()) topic.messages += messages->second;
  }
  for (auto& [name, topic] : contents.topics) topic.hz = rate(topic.messages, contents.length);
  return contents;
}

/// Reads all messages.
Contents contents_of(McapReader& reader) {
  struct Times {
    Time first, last;
    void add(Time time, bool is_first) {
      first = is_first ? time : std::min(first, time);
      last = is_first ? time : std::max(last, time);
    }
  };
  Contents contents;
  std::map<std::string, Times> sent;
  Times arrived;
  bool is_first = true;
  while (const auto message = reader.next()) {
    TopicCount& topic = contents.topics[message->channel->topic];
    sent[message->channel->topic].add(message->publish_time, topic.messages++ == 0);
    arrived.add(message->log_time, std::exchange(is_first, false));
    topic.bytes = topic.bytes.value_or(0) + message->data.size();
  }
  for (const auto& [id, channel] : reader.channels()) {
    contents.topics[channel.topic].type = type_of(channel, reader.schemas());
  }
  for (auto& [name, topic] : contents.topics) {
    topic.bytes = topic.bytes.value_or(0);
    topic.hz = rate(topic.messages, sent[name].last - sent[name].first);
  }
  contents.library = reader.library();
  contents.length = arrived.last - arrived.first;
  contents.chunks = reader.chunks();
  contents.packed_bytes = reader.packed_bytes();
  contents.unpacked_bytes = reader.unpacked_bytes();
  for (const McapAttachment& attachment : reader.attachments()) {
    contents.attachments.push_back({attachment.name, attachment.data.size()});
  }
  contents.metadata = reader.metadata();
  return contents;
}

Json json_of(const Contents& contents, const std::vector<std::string>& problems) {
  Json json{{"library", contents.library},
            {"whole", problems.empty()},
            {"problems", problems},
            {"length_s", to_seconds(contents.length)},
            {"chunks", contents.chunks},
            {"packed_bytes", contents.packed_bytes},
            {"unpacked_bytes", contents.unpacked_bytes},
            {"topics", Json::array()},
            {"attachments", Json::array()},
            {"metadata", Json::array()}};
  for (const auto& [name, topic] : contents.topics) {
    Json told{{"topic", name}, {"type", topic.type}, {"messages", topic.messages}};
    if (topic.bytes) told["bytes"] = *topic.bytes;
    json["topics"].push_back(std::move(told));
  }
  for (const auto& [name, bytes] : contents.attachments) {
    json["attachments"].push_back({{"name", name}, {"bytes", bytes}});
  }
  for (const McapMetadata& metadata : contents.metadata) {
    json["metadata"].push_back({{"name", metadata.name}, {"values", metadata.values}});
  }
  if (contents.links > 0) json["chain"] = {{"links", contents.links}, {"head", contents.head}};
  return json;
}

void print(const Contents& contents) {
  fmt::print("{:.3f} s by {}, {} in {} chunks, {} unpacked\n", to_seconds(contents.length),
             shown(contents.library), megabytes(contents.packed_bytes), contents.chunks,
             megabytes(contents.unpacked_bytes));
  std::size_t width = 0;
  for (const auto& [name, topic] : contents.topics) width = std::max(width, name.size());
  for (const auto& [name, topic] : contents.topics) {
    fmt::print("  {:<{}}  {:<40} {:>9} messages {:>9.1f} Hz", shown(name), width, shown(topic.type),
               topic.messages, topic.hz);
    fmt::print("{}\n", topic.bytes ? fmt::format(" {:>14}", megabytes(*topic.bytes)) : "");
  }
  for (const auto& [name, bytes] : contents.attachments) {
    fmt::print("  attached: {}, {} bytes\n", shown(name), bytes);
  }
  for (const McapMetadata& metadata : contents.metadata) {
    fmt::print("  {}:", shown(metadata.name));
    for (const auto& [key, value] : metadata.values) {
      fmt::print(" {}={}", shown(key), shown(value));
    }
    fmt::print("\n");
  }
  if (contents.links > 0) {
    fmt::print("  {} links, the last is {}: --verify holds the file to them\n", contents.links,
               contents.head);
  }
}

/// A log time as people say it: "2026-11-26 10:15:23.004 UTC".
std::string moment(Time time) {
  const std::int64_t s = time.ns / 1'000'000'000, ms = time.ns / 1'000'000 % 1000;
  return fmt::format("{:%Y-%m-%d %H:%M:%S}.{:03} UTC", fmt::gmtime(static_cast<std::time_t>(s)),
                     ms);
}

std::string_view word_of(McapChain::Verdict verdict) {
  switch (verdict) {
    case McapChain::Verdict::whole:
      return "whole";
    case McapChain::Verdict::cut:
      return "cut";
    case McapChain::Verdict::changed:
      return "changed";
    case McapChain::Verdict::none:
      break;
  }
  return "none";
}

/// What the chain says of the file, in a line or two; `elsewhere`: something is wrong all the same.
std::string told_by(const McapChain& chain, bool elsewhere) {
  switch (chain.verdict) {
    case McapChain::Verdict::none:
      return "it has no chain of hashes: whether it was changed cannot be told";
    case McapChain::Verdict::whole:
      return fmt::format("{}: {} links, the last is {}",
                         elsewhere ? "the chain is right to its end, and something is wrong "
                                     "outside of it"
                                   : "whole and unchanged",
                         chain.links, chain.head);
    case McapChain::Verdict::cut:
      return fmt::format(
          "cut off{}: the chain is right up to there, {} chunks and {} bytes: {} links, the last "
          "is {}",
          chain.chunks > 0 ? " after " + moment(chain.until) : " before its first chunk",
          chain.chunks, chain.bytes, chain.links, chain.head);
    case McapChain::Verdict::changed:
      break;
  }
  std::string text;
  for (const std::string& change : chain.changes) {
    text += (text.empty() ? "changed: " : "; ") + change;
  }
  return text;
}

Json json_of(const McapChain& chain) {
  return {{"verdict", word_of(chain.verdict)},
          {"links", chain.links},
          {"head", chain.head},
          {"chunks", chain.chunks},
          {"bytes", chain.bytes},
          {"until_ns", chain.until.ns},
          {"changes", chain.changes}};
}

void tell_problems(const std::filesystem::path& file, const std::vector<std::string>& problems) {
  for (const std::string& problem : problems) {
    fmt::print(stderr, "armature: '{}' is not whole: {}\n", file.string(), problem);
  }
  fmt::print(stderr,
             "armature: what can be read of it is saved by: armature record --repair {} -o "
             "whole.mcap\n",
             file.string());
}

/// How the file is that was repaired, for the metadata of the new one.
McapMetadata repaired_from(const std::filesystem::path& cut, const McapReader& reader) {
  const McapChain chain = reader.chain();
  return {.name = "armature.repaired",
          .values = {{"file", cut.filename().string()},
                     {"sha256", sha256_of_file(cut)},
                     {"chain", std::string{word_of(chain.verdict)}},
                     {"chain_links", std::to_string(chain.links)},
                     {"chain_head", chain.head},
                     {"problems", std::to_string(reader.problems().size())}}};
}

}  // namespace

void refuse_to_replace(const std::filesystem::path& file, bool force) {
  std::error_code error;
  const bool has_content =
      std::filesystem::is_regular_file(file, error) && std::filesystem::file_size(file, error) > 0;
  if (!has_content || force) return;
  throw InvalidChoice(fmt::format("'{}' is there already; --force replaces it", file.string()));
}

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
  tell_lost(recorder);
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
    std::uint64_t dropped = 0, lost = 0;
    for (const auto& [topic, count] : recorder.dropped()) dropped += count;
    for (const auto& [topic, count] : recorder.lost()) lost += count;
    fmt::print("{}\n", Json{{"file", options.out.string()},
                            {"topics", recorder.topics()},
                            {"messages", recorder.messages()},
                            {"bytes", recorder.bytes()},
                            {"dropped", dropped},
                            {"lost", lost},
                            {"head", recorder.head()}}
                           .dump());
  } else {
    fmt::print("{}: {} messages of {} topics, {}\n", options.out.string(), recorder.messages(),
               recorder.topics(), megabytes(recorder.bytes()));
    fmt::print("last hash {}\n", recorder.head());
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
  McapReader reader{cut, true};
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
  writer.add(repaired_from(cut, reader));
  writer.close();
  for (const std::string& problem : reader.problems()) {
    fmt::print(stderr, "armature: '{}': {}\n", cut.string(), problem);
  }
  fmt::print("{}: {} messages{}\n", whole.string(), writer.messages(),
             reader.problems().empty() ? ", all of a file that was whole" : "");
  return kOk;
}

int describe_recording(const InfoOptions& options) {
  if (!options.verify) {
    if (const auto summary = read_summary(options.file)) {
      const Contents contents = contents_of(*summary);
      if (options.json) {
        fmt::print("{}\n", text_of(json_of(contents, {})));
      } else {
        print(contents);
      }
      return kOk;
    }
  }
  McapReader reader{options.file, options.verify};
  const Contents contents = contents_of(reader);
  const McapChain chain = reader.chain();
  const bool is_head = options.head.empty() || options.head == chain.head;
  if (options.json) {
    Json json = json_of(contents, reader.problems());
    if (options.verify) json["chain"] = json_of(chain);
    if (!options.head.empty()) json["chain"]["is_head"] = is_head;
    fmt::print("{}\n", text_of(json));
  } else {
    print(contents);
  }
  if (!reader.problems().empty()) tell_problems(options.file, reader.problems());
  if (!options.verify) return reader.problems().empty() ? kOk : kFailed;
  const bool is_whole = chain.verdict == McapChain::Verdict::whole && reader.problems().empty();
  const std::string told = told_by(chain, !reader.problems().empty());
  if (!is_whole) {
    fmt::print(stderr, "armature: '{}': {}\n", options.file.string(), told);
  } else if (!options.json) {
    fmt::print("{}\n", told);
  }
  if (!is_head) {
    fmt::print(stderr, "armature: '{}': its last hash is not {}: it is another file\n",
               options.file.string(), options.head);
  }
  return is_whole && is_head ? kOk : kFailed;
}

}  // namespace armature
