// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include "armature/recording/mcap_reader.hpp"
#include "armature/recording/recorded_processes.hpp"

namespace armature {

/// The contents of a recording that was read once.
struct RunContents {
  struct Topic {
    std::string type;
    std::uint64_t messages = 0;
  };
  std::map<std::string, Topic> topics;
  std::uint64_t messages = 0;
  std::uint64_t thinned = 0;  // that came, too, and that a thin recording has left out
  Time first, last;
  McapChain chain;
  bool is_whole = true;
  std::vector<std::string> repairs;               // of files that were not whole
  RecordedCopies copies;                          // of messages that are in it, too
  std::map<std::string, std::string> deployment;  // version, fingerprint, ..
  std::string figures;                            // of the run, as JSON; empty: it has none

  double hz(const Topic& topic) const {
    const double length_s = to_seconds(last - first);
    return length_s > 0 ? static_cast<double>(topic.messages) / length_s : 0;
  }
};

/// Throws std::runtime_error for what cannot be read or is no recording.
RunContents read_contents(const std::filesystem::path& recording);

struct Reduced {
  std::string bytes;
  std::uint64_t messages = 0;
};

/// A recording as it stands in a page: fewer messages of fast topics, raw pictures as JPEG or none.
/// Leaves out messages that have come to the file since `contents` were read. Throws InvalidChoice
/// for one that is too long for a page, std::runtime_error for what cannot be read.
Reduced reduced(const std::filesystem::path& recording, const RunContents& contents,
                bool with_pictures);

/// All of a file. Throws std::runtime_error.
std::string bytes_of(const std::filesystem::path& file);

}  // namespace armature
