// SPDX-License-Identifier: Apache-2.0
#include "armature/recording/recorded_processes.hpp"

#include <algorithm>
#include <sstream>

#include "armature/recording/mcap_reader.hpp"

namespace armature {

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

}  // namespace armature
