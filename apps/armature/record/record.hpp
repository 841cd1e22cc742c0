// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <cstdio>
#include <filesystem>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "armature/recording/chain_check.hpp"
#include "watch/outsider.hpp"

namespace armature {

struct RecordOptions : WatchOptions {
  std::filesystem::path out;
  std::vector<std::string> topics;  // empty: all; "/dental_lamp/*": all that begin so
  bool compress = true;
  bool force = false;  // replace a file that is there
};

/// Records topics of running deployments as MCAP until it is interrupted, or --timeout is over.
int record_topics(const RecordOptions& options);
/// Writes what can be read of a recording that was cut off as a whole one.
int repair_recording(const std::filesystem::path& cut, const std::filesystem::path& whole,
                     bool force);
/// A file that nobody else writes for as long as it is held; empty where nothing is to be held.
using HeldFile = std::unique_ptr<std::FILE, int (*)(std::FILE*)>;
/// Holds a file that has something in it, so that another can take its place. Throws InvalidChoice
/// unless it may be replaced, and std::runtime_error while another program writes it.
[[nodiscard]] HeldFile hold_to_replace(const std::filesystem::path& file, bool may_be_replaced);

/// "69.062 MB".
std::string megabytes(std::uint64_t bytes);
/// "whole", "cut", "changed" or "none".
std::string_view word_of(McapChain::Verdict verdict);

struct InfoOptions {
  std::filesystem::path file;
  bool json = false;
  bool verify = false;  // every byte is read and held to the chain of hashes
  std::string head;     // what the last hash shall be; empty: that is not asked
};
/// Tells what is in a recording, as its summary says it, or as all of it does.
int describe_recording(const InfoOptions& options);

}  // namespace armature
