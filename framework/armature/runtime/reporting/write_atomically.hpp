// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string_view>

namespace armature ARMATURE_EXPORT {

/// What a file is for. A report is its owner's only (0600), and replaces a link that lies in its
/// place. A file that the user names has the permissions that the user gives (umask), and a link
/// keeps pointing to it.
enum class FileUse { report, named_by_user };

/// Whoever reads `file` finds what was there before or all of `text`, also after a crash. Throws
/// std::runtime_error with the reason; then the file is as it was.
void write_atomically(const std::filesystem::path& file, std::string_view text,
                      FileUse use = FileUse::report);

}  // namespace armature
