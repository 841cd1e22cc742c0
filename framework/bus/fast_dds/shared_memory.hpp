// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>

#include "armature/values/expected.hpp"

namespace armature {

/// Whether `folder` (/dev/shm) takes `bytes` more. Fast DDS does not ask: on a full one the process
/// dies of SIGBUS in the middle of a write.
Expected<void> check_shared_memory(const std::filesystem::path& folder, std::uint64_t bytes);

/// Removes what killed processes of this user left in `folder`: Fast DDS segments and ports that
/// nobody has locked or mapped, and data sharing files whose process is gone. Files younger than
/// `least_age_s` are left alone: their owner may be about to lock them. Returns how many went.
int clean_shared_memory(const std::filesystem::path& folder, double least_age_s = 10);

}  // namespace armature
