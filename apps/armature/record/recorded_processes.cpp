// SPDX-License-Identifier: Apache-2.0
#include "record/recorded_processes.hpp"

#include <algorithm>
#include <sstream>

#include "armature/recording/mcap_reader.hpp"
#include "armature/runtime/recording/recorded_description.hpp"

namespace armature {

std::vector<std::string> recorded_processes(const std::filesystem::path& file) {
  McapReader reader{file};
  std::vector<std::string> processes;
  const auto read = [&] {
    processes.clear();
    for (const McapMetadata& metadata : reader.metadata()) {
      const auto process = metadata.values.find(kProcessKey);
      if (metadata.name != kProcessMetadata || process == metadata.values.end()) continue;
      if (std::ranges::find(processes, process->second) == processes.end()) {
        processes.push_back(process->second);
      }
    }
    return !processes.empty();
  };
  // They stand at the beginning, but behind everything in a recording that was repaired.
  while (reader.next() && !read()) continue;
  if (!read()) processes.emplace_back();
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
