// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "armature/recording/mcap.hpp"

namespace armature ARMATURE_EXPORT {

/// Name of the metadata that a process puts into its recording.
inline constexpr std::string_view kProcessMetadata = "armature.process";
/// Keys of a channel's metadata: the process that recorded it, and of samples that came from other
/// processes of the deployment the names of these, "vision,arm".
inline constexpr const char* kProcessKey = "process";
inline constexpr const char* kFromKey = "from";

/// The processes whose recordings stand in a file: one, unless files were joined; of a recording
/// from outside one without a name. Throws std::runtime_error for a file that is no recording.
std::vector<std::string> recorded_processes(const std::filesystem::path& file);

/// The same of what a file says of itself; empty: it does not name one.
std::vector<std::string> processes_of(const std::vector<McapMetadata>& metadata);

/// True when a channel has what one process got from others, and the recordings of all of these are
/// in the file, too: whoever shows or plays all channels has it twice.
bool is_doubled(const McapChannel& channel, const std::vector<std::string>& processes);

}  // namespace armature
