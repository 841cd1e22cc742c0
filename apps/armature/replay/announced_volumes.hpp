// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <map>
#include <string>

namespace armature {

/// A recording holds of a volume its path and the SHA-256 of its voxels, not the volume. Of each
/// topic that announces one which is no longer there, or is another one now: why, by the topic.
/// Reads the volumes. Throws std::runtime_error for a recording that cannot be read.
std::map<std::string, std::string> lost_volumes(const std::filesystem::path& recording);

}  // namespace armature
