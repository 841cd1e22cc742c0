// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

namespace armature {

/// Of a recording that was joined.
struct JoinedRecording {
  std::uint64_t messages = 0, bytes = 0;
  std::size_t processes = 0;
  std::string head;  // the last hash of its chain
  std::vector<std::string>
      problems;  // what is wrong with the parts: "'run.vision.mcap': it ends .."
};

/// Joins what the processes of one run have recorded, on whichever hosts, into one file. Parts are
/// the files of one process each, or of several that were joined before. In it are all messages in
/// the order of their times, those of each part in their own; attachments and metadata once. What
/// can be read of a part that was cut off or damaged is in it, and the metadata `armature.part` of
/// each says so. All times are by the deployment's clock, which the hosts of a run share. `out` may
/// be one of the parts, and is replaced when all of it is written. Throws InvalidChoice for files
/// that are not parts of one run, std::runtime_error for what cannot be read or written; then `out`
/// is as it was.
JoinedRecording join_recordings(const std::vector<std::filesystem::path>& parts,
                                const std::filesystem::path& out);

/// `armature record --merge A B -o C`.
int merge_recordings(const std::vector<std::filesystem::path>& parts,
                     const std::filesystem::path& out, bool force);

}  // namespace armature
