// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <string>
#include <string_view>
#include <vector>

#include "armature/recording/mcap.hpp"

namespace armature ARMATURE_EXPORT {

struct McapMessage;

/// Names of the metadata that a process puts into its recording at its beginning and end, and of
/// what others have done to it.
inline constexpr std::string_view kProcessMetadata = "armature.process";
inline constexpr std::string_view kEndMetadata = "armature.end";    // missing: it was cut off
inline constexpr std::string_view kPartMetadata = "armature.part";  // of files that were joined
inline constexpr std::string_view kRepairedMetadata = "armature.repaired";  // by record --repair
/// Keys of a channel's metadata: the process that recorded it, and of samples that came from other
/// processes of the deployment the names of these, "vision,arm".
inline constexpr const char* kProcessKey = "process";
inline constexpr const char* kFromKey = "from";
/// Key of a channel with samples of one writer in another process: they have the numbers that it
/// gave them, and so have those that its own process recorded.
inline constexpr const char* kNumberedKey = "numbered";

/// The processes whose recordings stand in a file: one, unless files were joined; of a recording
/// from outside one without a name. Throws std::runtime_error for a file that is no recording.
std::vector<std::string> recorded_processes(const std::filesystem::path& file);

/// The same of what a file says of itself; empty: it does not name one.
std::vector<std::string> processes_of(const std::vector<McapMetadata>& metadata);

/// True when a channel has what one process got from others, and the recordings of all of these are
/// in the file, too: whoever shows or plays all channels has it twice.
bool is_doubled(const McapChannel& channel, const std::vector<std::string>& processes);

/// The messages of a recording that stand in it twice, and that whoever shows or plays it leaves
/// out. The recording of a process that was killed lacks its last messages: of those one copy is
/// kept, that of the process that got most of the topic.
class RecordedCopies {
 public:
  RecordedCopies() = default;  // none
  /// Throws std::runtime_error for a file that is no recording.
  explicit RecordedCopies(const std::filesystem::path& file);

  bool has(const McapMessage& message) const;
  /// Whether it depends on the channel alone: no process of several was killed.
  bool are_whole_channels() const { return last_.empty(); }

 private:
  std::vector<std::string> processes_;
  /// The number of the last message of a channel.
  struct Last {
    std::uint16_t channel = 0;
    std::uint32_t sequence = 0;
  };
  std::map<std::string, std::uint32_t> last_;  // by topic: the number of the last of its writer
  std::map<std::string, Last> copied_;         // by topic: the copy that goes on for longest
};

}  // namespace armature
