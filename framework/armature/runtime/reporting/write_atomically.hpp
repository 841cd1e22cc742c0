// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string_view>

namespace armature ARMATURE_EXPORT {

/// What a file is for. A report is its owner's only (0600), and replaces a link that lies in its
/// place. To a file that the user names a link keeps pointing; it has the permissions that the user
/// gives (umask), but for one about a patient, which is its owner's only.
enum class FileUse { report, named_by_user, patient_file };

/// Whoever reads `file` finds what was there before or all of `text`, also after a crash. Throws
/// std::runtime_error with the reason; then the file is as it was.
void write_atomically(const std::filesystem::path& file, std::string_view text,
                      FileUse use = FileUse::report);

/// Throws as `write_atomically` does where `file`, which a user names, is write-protected: for a
/// program that writes several, before its work.
void refuse_write_protected(const std::filesystem::path& file);

}  // namespace armature
