// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <optional>
#include <string>

namespace armature ARMATURE_EXPORT {

/// Who besides the user could change what a folder of plugins or a library is, and with it what
/// this process runs: "others may write it (mode 0777)", "it belongs to user 1000". Nothing when
/// the place that `path` leads to (and every folder above it) belongs to the user, to root or to
/// the owner of this framework's own library, and nobody else may write there.
std::optional<std::string> danger_of_place(const std::filesystem::path& path);

}  // namespace armature
