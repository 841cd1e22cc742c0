// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>

namespace armature ARMATURE_EXPORT {

/// Keeps every other writer out of an open file until `descriptor` is closed, also by the end of
/// the program. What is no regular file, and what stands on a file system without locks, is left
/// alone. Throws std::runtime_error when another writer has it.
void lock_for_writing(int descriptor, const std::filesystem::path& file);

}  // namespace armature
