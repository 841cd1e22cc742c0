// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string_view>

namespace armature {

/// Whoever reads `file` finds what was there before or all of `text`, also after a crash. Throws
/// std::runtime_error with the reason; then the file is as it was.
void write_atomically(const std::filesystem::path& file, std::string_view text);

}  // namespace armature
