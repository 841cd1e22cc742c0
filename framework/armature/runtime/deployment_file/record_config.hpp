// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "armature/config/node.hpp"
#include "armature/config/problems.hpp"
#include "armature/values/time.hpp"

namespace armature ARMATURE_EXPORT {

struct ComponentConfig;

/// `record:` of a deployment file: what a run keeps of itself, to be replayed.
struct RecordConfig {
  std::filesystem::path file;  // as written; may say the time, UTC, by strftime: "%Y%m%d-%H%M.mcap"
  std::vector<std::string> topics;  // "/dental_lamp/*" for all that begin so; empty: all
  bool compress = true;
  bool thin = false;                      // only as much as a page of the run shows, no activations
  std::optional<Duration> around_faults;  // only so long before and after one
  config::Origin origin;                  // of the file's name, which begins in its folder

  /// Where `process` of a run that began at `start` (Unix time) writes: every process but "main"
  /// has a file of its own, "run.vision.mcap".
  std::filesystem::path file_of(std::string_view process, Time start) const;
  /// The same of the main process' file, which has its time already.
  static std::filesystem::path part_of(std::filesystem::path main_file, std::string_view process);
};

RecordConfig read_record(const config::Node& section, config::Problems& problems);

/// Refuses topics that neither one of `components` writes or reads nor the runtime writes.
void check_record(const RecordConfig& record, const config::Node& section,
                  const std::string& deployment, const std::vector<ComponentConfig>& components,
                  config::Problems& problems);

/// True when `pattern` is `topic`, or ends in '*' and `topic` begins with what stands before.
bool matches_topic(std::string_view pattern, std::string_view topic);

}  // namespace armature
