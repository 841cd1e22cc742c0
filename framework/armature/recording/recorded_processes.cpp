// SPDX-License-Identifier: Apache-2.0
#include "armature/recording/recorded_processes.hpp"

#include <algorithm>
#include <sstream>

#include "armature/recording/mcap_reader.hpp"
#include "armature/recording/mcap_summary.hpp"

namespace armature {
namespace {

/// Whether the recordings of all these processes have come to their ends, and nothing was lost of
/// them since.
bool are_all_whole(const std::vector<McapMetadata>& metadata,
                   const std::vector<std::string>& processes) {
  std::size_t ends = 0;
  for (const McapMetadata& one : metadata) {
    if (one.name == kEndMetadata) ++ends;
    if (one.name != kRepairedMetadata && one.name != kPartMetadata) continue;
    const auto chain = one.values.find("chain");
    if (chain == one.values.end() || chain->second != "whole") return false;
  }
  return ends >= processes.size();
}

}  // namespace

std::vector<std::string> recorded_processes(const std::filesystem::path& file) {
  McapReader reader{file};
  // They stand at the beginning, but behind everything in a recording that an older version
  // repaired.
  while (reader.next() && processes_of(reader.metadata()).empty()) continue;
  std::vector<std::string> processes = processes_of(reader.metadata());
  if (processes.empty()) processes.emplace_back();
  return processes;
}

std::vector<std::string> processes_of(const std::vector<McapMetadata>& metadata) {
  std::vector<std::string> processes;
  for (const McapMetadata& one : metadata) {
    const auto process = one.values.find(kProcessKey);
    if (one.name != kProcessMetadata || process == one.values.end()) continue;
    if (std::ranges::find(processes, process->second) == processes.end()) {
      processes.push_back(process->second);
    }
  }
  return processes;
}

bool is_doubled(const McapChannel& channel, const std::vector<std::string>& processes) {
  const auto from = channel.metadata.find(kFromKey);
  if (from == channel.metadata.end()) return false;
  std::istringstream names{from->second};
  for (std::string name; std::getline(names, name, ',');) {
    if (std::ranges::find(processes, name) == processes.end()) return false;
  }
  return true;
}

RecordedCopies::RecordedCopies(const std::filesystem::path& file) {
  const auto summary = read_summary(file);
  processes_ = summary ? processes_of(summary->metadata) : recorded_processes(file);
  if (processes_.size() < 2) return;
  if (summary && are_all_whole(summary->metadata, processes_)) return;
  McapReader reader{file};
  while (const auto message = reader.next()) {
    const McapChannel& channel = *message->channel;
    if (!channel.metadata.contains(kFromKey)) {
      std::uint32_t& last = last_[channel.topic];
      last = std::max(last, message->sequence);
    } else if (Last& copied = copied_[channel.topic]; message->sequence > copied.sequence) {
      copied = {channel.id, message->sequence};
    }
  }
}

bool RecordedCopies::has(const McapMessage& message) const {
  if (!is_doubled(*message.channel, processes_)) return false;
  if (last_.empty() || !message.channel->metadata.contains(kNumberedKey)) return true;
  const std::string& topic = message.channel->topic;
  const auto last = last_.find(topic);
  if (last != last_.end() && message.sequence <= last->second) return true;
  const auto copied = copied_.find(topic);
  return copied == copied_.end() || copied->second.channel != message.channel->id;
}

}  // namespace armature
