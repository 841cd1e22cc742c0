// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>
#include <vector>

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
/// Tells what is in a recording.
int describe_recording(const std::filesystem::path& file, bool json);

}  // namespace armature
