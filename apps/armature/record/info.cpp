// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <algorithm>
#include <cstdio>
#include <ctime>
#include <nlohmann/json.hpp>
#include <utility>

#include "armature/recording/mcap_reader.hpp"
#include "armature/recording/mcap_summary.hpp"
#include "armature/recording/recorded_processes.hpp"
#include "armature/values/json_text.hpp"
#include "date_text.hpp"
#include "exit_code.hpp"
#include "record/record.hpp"
#include "record/repaired.hpp"
#include "shell_word.hpp"
#include "standard_output.hpp"
#include "terminal_text.hpp"

namespace armature {
namespace {

using Json = nlohmann::ordered_json;

std::string text_of(const Json& json) { return json_text(json); }

/// A message that was recorded twice, by its writer's process and by a reader's, counts once.
struct TopicCount {
  std::uint64_t messages = 0, doubled = 0;
  std::optional<std::uint64_t> bytes;  // a summary does not tell
  std::optional<double> hz;            // nor that: when the topic came first and last
};

/// The contents of a recording, read from its summary or from all of it.
struct Contents {
  bool is_all_read = false;
  std::string library;
  Duration length{0};
  std::uint64_t chunks = 0, packed_bytes = 0, unpacked_bytes = 0;
  std::map<std::pair<std::string, std::string>, TopicCount> topics;  // by name and type
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
  Contents contents{.is_all_read = false,
                    .library = summary.library,
                    .length = summary.last - summary.first,
                    .chunks = summary.chunks,
                    .packed_bytes = summary.packed_bytes,
                    .unpacked_bytes = summary.unpacked_bytes,
                    .attachments = summary.attachments,
                    .metadata = summary.metadata,
                    .links = summary.links,
                    .head = summary.head};
  const std::vector<std::string> processes = processes_of(summary.metadata);
  for (const auto& [id, channel] : summary.channels) {
    TopicCount& topic = contents.topics[{channel.topic, type_of(channel, summary.schemas)}];
    const auto messages = summary.messages.find(id);
    if (messages == summary.messages.end()) continue;
    (is_doubled(channel, processes) ? topic.doubled : topic.messages) += messages->second;
  }
  return contents;
}

/// Reads all messages.
Contents contents_of(McapReader& reader, const RecordedCopies& copies) {
  struct Times {
    Time first, last;
    void add(Time time, bool is_first) {
      first = is_first ? time : std::min(first, time);
      last = is_first ? time : std::max(last, time);
    }
  };
  Contents contents{.is_all_read = true};
  std::map<std::pair<std::string, std::string>, Times> sent;
  Times arrived;
  bool is_first = true;
  while (const auto message = reader.next()) {
    const std::pair key{message->channel->topic, type_of(*message->channel, reader.schemas())};
    TopicCount& topic = contents.topics[key];
    arrived.add(message->log_time, std::exchange(is_first, false));
    if (copies.has(*message)) {
      ++topic.doubled;
      continue;
    }
    sent[key].add(message->publish_time, topic.messages++ == 0);
    topic.bytes = topic.bytes.value_or(0) + message->data.size();
  }
  for (const auto& [id, channel] : reader.channels()) {
    contents.topics[{channel.topic, type_of(channel, reader.schemas())}];
  }
  for (auto& [key, topic] : contents.topics) {
    topic.bytes = topic.bytes.value_or(0);
    topic.hz = rate(topic.messages, sent[key].last - sent[key].first);
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

std::uint64_t doubled_in(const Contents& contents) {
  std::uint64_t doubled = 0;
  for (const auto& [key, topic] : contents.topics) doubled += topic.doubled;
  return doubled;
}

Json json_of(const Contents& contents, const std::vector<std::string>& problems) {
  Json json{{"library", contents.library},
            // Its summary says nothing of what was changed since: null, which is not true.
            {"whole", contents.is_all_read ? Json(problems.empty()) : Json{}},
            {"problems", problems},
            {"repaired", repairs_told_by(contents.metadata)},
            {"lost", losses_told_by(contents.metadata)},
            {"length_s", to_seconds(contents.length)},
            {"chunks", contents.chunks},
            {"packed_bytes", contents.packed_bytes},
            {"unpacked_bytes", contents.unpacked_bytes},
            {"doubled", doubled_in(contents)},
            {"topics", Json::array()},
            {"attachments", Json::array()},
            {"metadata", Json::array()}};
  for (const auto& [key, topic] : contents.topics) {
    Json told{{"topic", key.first}, {"type", key.second}, {"messages", topic.messages}};
    if (topic.doubled > 0) told["doubled"] = topic.doubled;
    if (topic.bytes) told["bytes"] = *topic.bytes;
    if (topic.hz) told["hz"] = *topic.hz;
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
  print_out("{:.3f} s by {}, {} in {} chunks, {} unpacked\n", to_seconds(contents.length),
            terminal_text(contents.library), megabytes(contents.packed_bytes), contents.chunks,
            megabytes(contents.unpacked_bytes));
  std::size_t width = 0;
  for (const auto& [key, topic] : contents.topics) width = std::max(width, key.first.size());
  for (const auto& [key, topic] : contents.topics) {
    print_out("  {:<{}}  {:<40} {:>9} messages", terminal_text(key.first), width,
              terminal_text(key.second), topic.messages);
    if (topic.hz) print_out(" {:>9.1f} Hz", *topic.hz);
    print_out("{}\n", topic.bytes ? fmt::format(" {:>14}", megabytes(*topic.bytes)) : "");
  }
  if (const std::uint64_t doubled = doubled_in(contents)) {
    print_out("  {} more messages were recorded a second time, by a process that read them\n",
              doubled);
  }
  for (const auto& [name, bytes] : contents.attachments) {
    print_out("  attached: {}, {} bytes\n", terminal_text(name), bytes);
  }
  for (const McapMetadata& metadata : contents.metadata) {
    print_out("  {}:", terminal_text(metadata.name));
    for (const auto& [key, value] : metadata.values) {
      print_out(" {}={}", terminal_text(key), terminal_text(value));
    }
    print_out("\n");
  }
  for (const auto& told : {repairs_told_by(contents.metadata), losses_told_by(contents.metadata)}) {
    for (const std::string& text : told) print_out("  incomplete: {}\n", terminal_text(text));
  }
  if (contents.links > 0) {
    print_out("  {} links, the last is {}: --verify holds the file to them\n", contents.links,
              contents.head);
  }
}

/// A log time as people say it: "2026-11-26 10:15:23.004 UTC".
std::string moment(Time time) {
  const std::int64_t s = time.ns / 1'000'000'000, ms = time.ns / 1'000'000 % 1000;
  return fmt::format("{}.{:03} UTC", date_text(utc(s), "%Y-%m-%d %H:%M:%S"), ms);
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
    case McapChain::Verdict::changed: break;
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

/// True for a file of which --repair would save nothing.
bool is_nothing(const Contents& contents) {
  const auto has_messages = [](const auto& topic) {
    return topic.second.messages + topic.second.doubled > 0;
  };
  return std::ranges::none_of(contents.topics, has_messages) && contents.attachments.empty() &&
         contents.metadata.empty();
}

void tell_unreadable(const std::filesystem::path& file, const std::vector<std::string>& problems) {
  fmt::print(stderr, "armature: '{}': nothing can be read of it: {}\n", file.string(),
             terminal_text(problems.front()));
}

void tell_problems(const std::filesystem::path& file, const std::vector<std::string>& problems) {
  for (const std::string& problem : problems) {
    fmt::print(stderr, "armature: '{}' is not whole: {}\n", file.string(), terminal_text(problem));
  }
  fmt::print(stderr,
             "armature: what can be read of it is saved by: armature record --repair {} -o "
             "whole.mcap\n",
             shell_word(file.string()));
}

}  // namespace

std::string megabytes(std::uint64_t bytes) {
  return fmt::format("{:.3f} MB", 1e-6 * static_cast<double>(bytes));
}

std::string_view word_of(McapChain::Verdict verdict) {
  switch (verdict) {
    case McapChain::Verdict::whole: return "whole";
    case McapChain::Verdict::cut: return "cut";
    case McapChain::Verdict::changed: return "changed";
    case McapChain::Verdict::none: break;
  }
  return "none";
}

int describe_recording(const InfoOptions& options) {
  const RecordedCopies copies{options.file};
  if (!options.verify && copies.are_whole_channels()) {
    if (const auto summary = read_summary(options.file)) {
      const Contents contents = contents_of(*summary);
      if (options.json) {
        print_out("{}\n", text_of(json_of(contents, {})));
      } else {
        print(contents);
      }
      return kOk;
    }
  }
  McapReader reader{options.file, options.verify};
  const Contents contents = contents_of(reader, copies);
  const bool is_unreadable = !reader.problems().empty() && is_nothing(contents);
  const McapChain chain = reader.chain();
  const bool is_head = options.head.empty() || options.head == chain.head;
  if (options.json) {
    Json json = json_of(contents, reader.problems());
    if (options.verify) json["chain"] = json_of(chain);
    if (!options.head.empty()) json["chain"]["is_head"] = is_head;
    print_out("{}\n", text_of(json));
  } else if (!is_unreadable) {
    print(contents);
  }
  std::fflush(standard_output());  // a reader of both has this before what is wrong
  if (!reader.problems().empty()) {
    (is_unreadable ? tell_unreadable : tell_problems)(options.file, reader.problems());
  }
  if (!options.verify) return reader.problems().empty() ? kOk : kFailed;
  const bool is_whole = chain.verdict == McapChain::Verdict::whole && reader.problems().empty();
  const std::string told = told_by(chain, !reader.problems().empty());
  if (!is_whole) {
    fmt::print(stderr, "armature: '{}': {}\n", options.file.string(), told);
  } else if (!options.json) {
    print_out("{}\n", told);
  }
  if (!is_head) {
    fmt::print(stderr, "armature: '{}': its last hash is not {}: it is another file\n",
               options.file.string(), options.head);
  }
  return is_whole && is_head ? kOk : kFailed;
}

}  // namespace armature
