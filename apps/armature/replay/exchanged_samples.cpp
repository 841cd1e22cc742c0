// SPDX-License-Identifier: Apache-2.0
#include "replay/exchanged_samples.hpp"

#include <algorithm>
#include <charconv>
#include <functional>
#include <map>
#include <string_view>
#include <unordered_map>
#include <utility>
#include <vector>

#include "armature/recording/mcap_reader.hpp"
#include "armature/recording/recorded_processes.hpp"
#include "armature/runtime/recording/recorded_description.hpp"

namespace armature {
namespace {

std::size_t hash_of(const McapMessage& message) {
  return std::hash<std::string_view>{}(
      {reinterpret_cast<const char*>(message.data.data()), message.data.size()});
}

std::string process_of(const McapChannel& channel) {
  const auto process = channel.metadata.find(kProcessKey);
  return process == channel.metadata.end() ? std::string{} : process->second;
}

/// The samples of one writer: the places of each content in their order, and the content of each
/// number.
struct Written {
  std::uint64_t count = 0;
  std::unordered_map<std::size_t, std::vector<std::uint64_t>> places;  // by hash, ascending
  std::unordered_map<std::uint32_t, std::size_t> hashes;               // by number

  /// The number, if it comes behind `after` and has that content.
  std::optional<std::uint64_t> find_number(std::uint32_t number, std::size_t hash,
                                           std::uint64_t after) const {
    const auto known = hashes.find(number);
    const bool is_it = known != hashes.end() && known->second == hash && number > after;
    return is_it ? std::optional<std::uint64_t>{number} : std::nullopt;
  }
  /// The first place of it behind `after`.
  std::optional<std::uint64_t> find(std::size_t hash, std::uint64_t after) const {
    const auto known = places.find(hash);
    if (known == places.end()) return std::nullopt;
    const auto place = std::ranges::upper_bound(known->second, after);
    return place == known->second.end() ? std::nullopt : std::optional{*place};
  }
};

/// What one process got of a topic from others.
struct Copy {
  std::uint32_t sequence;  // in the order in which it came
  std::size_t hash;
  Time at;
};
struct Copies {
  McapChannel channel;
  std::vector<Copy> read;
};

/// By topic and channel.
using Writers = std::map<std::string, std::map<std::uint16_t, Written>>;

/// Whether the only writer of a topic has written the copy behind `last`, which is then its place.
bool is_next(const Written& written, const Copy& copy, bool is_numbered, std::uint64_t& last) {
  const auto place = is_numbered ? written.find_number(copy.sequence, copy.hash, last)
                                 : written.find(copy.hash, last);
  if (place) last = *place;
  return place.has_value();
}

/// Counts how often several writers together have written that content. Which of them a copy is
/// from is not told, so their order cannot be held to anything.
std::uint64_t times_written(const std::map<std::uint16_t, Written>& writers, std::size_t hash) {
  std::uint64_t times = 0;
  for (const auto& [channel, written] : writers) {
    const auto places = written.places.find(hash);
    if (places != written.places.end()) times += places->second.size();
  }
  return times;
}

/// Whether it has what the process itself has published. It numbers writers elsewhere, also those
/// of other programs, from 2^31 on (RemoteTopics).
bool is_original(const McapChannel& channel) {
  const auto writer = channel.metadata.find("writer");
  if (writer == channel.metadata.end()) return false;
  std::uint32_t number = 0;
  const std::string& text = writer->second;
  const auto end = std::from_chars(text.data(), text.data() + text.size(), number).ptr;
  return end == text.data() + text.size() && number < 1U << 31;
}

Writers all_written(const std::filesystem::path& file) {
  McapReader reader{file};
  Writers writers;
  while (const auto message = reader.next()) {
    if (!is_original(*message->channel)) continue;
    Written& written = writers[message->channel->topic][message->channel->id];
    const std::size_t hash = hash_of(*message);
    written.places[hash].push_back(++written.count);
    written.hashes[message->sequence] = hash;
  }
  return writers;
}

}  // namespace

ExchangedSamples compare_exchanged(const std::filesystem::path& file) {
  ExchangedSamples exchanged;
  const std::vector<std::string> processes = recorded_processes(file);
  if (processes.size() < 2) return exchanged;
  const Writers writers = all_written(file);
  std::map<std::uint16_t, Copies> all;  // by channel
  std::optional<Time> start, first;
  McapReader reader{file};
  while (const auto message = reader.next()) {
    if (!start) start = message->log_time;
    const McapChannel& channel = *message->channel;
    if (!is_doubled(channel, processes) || !writers.contains(channel.topic)) continue;
    Copies& copies =
        all.try_emplace(channel.id, Copies{.channel = channel, .read = {}}).first->second;
    copies.read.push_back({message->sequence, hash_of(*message), message->log_time});
  }
  for (auto& [id, copies] : all) {
    // Of a queue one component may be shown what came before the newest, which another one was
    // shown first.
    std::ranges::stable_sort(copies.read, {}, &Copy::sequence);
    const bool is_numbered = copies.channel.metadata.contains(kNumberedKey);
    const auto& candidates = writers.at(copies.channel.topic);
    std::uint64_t last = 0;                     // of the only writer
    std::map<std::size_t, std::uint64_t> read;  // of several: how often each content
    for (const Copy& copy : copies.read) {
      const bool is_written = candidates.size() > 1
                                  ? ++read[copy.hash] <= times_written(candidates, copy.hash)
                                  : is_next(candidates.begin()->second, copy, is_numbered, last);
      ++(is_written ? exchanged.compared : exchanged.unwritten);
      if (is_written && is_numbered) ++exchanged.numbered;
      if (is_written || (first && *first <= copy.at)) continue;
      first = copy.at;
      exchanged.first = {.topic = copies.channel.topic,
                         .reader = process_of(copies.channel),
                         .at_s = to_seconds(copy.at - *start)};
    }
  }
  return exchanged;
}

}  // namespace armature
