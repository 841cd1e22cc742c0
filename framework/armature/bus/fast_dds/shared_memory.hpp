// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <vector>

#include "armature/values/expected.hpp"

namespace armature ARMATURE_EXPORT {

// A camera image must fit several times; the default of 512 KiB makes its round trip 50 times
// longer.
inline constexpr std::uint32_t kSharedMemorySegment = 16U << 20;
/// Greatest message that goes through it [B].
inline constexpr std::uint32_t kGreatestMessageBytes = 4U << 20;
/// What a process takes in all [B].
inline constexpr std::uint64_t kSharedMemoryOfProcess = kSharedMemorySegment + (2U << 20);  // ports

/// Bytes that the file system of `folder` has left for us, or why it cannot be known.
Expected<std::uint64_t> free_bytes_of(const std::filesystem::path& folder);

/// Where Fast DDS puts its segments, and how the room there is measured.
struct SharedMemory {
  std::filesystem::path folder = "/dev/shm";
  std::function<Expected<std::uint64_t>(const std::filesystem::path&)> free_bytes = free_bytes_of;
};

/// Whether `memory` takes `bytes` more. Fast DDS does not ask: on a full one the process dies of
/// SIGBUS in the middle of a write.
Expected<void> check_shared_memory(const SharedMemory& memory, std::uint64_t bytes);

/// Whether what this process sends to that port of `folder` reaches a participant of another
/// process. Participants of two such folders have the same ports.
Expected<void> check_shared_memory_port(const std::filesystem::path& folder, std::uint32_t port);

/// Makes what Fast DDS has made for this process in `folder` its user's only: it gives its files to
/// all users to read, whatever the umask, and samples lie there. A program that opened one before
/// keeps it, so this is called at once.
void make_shared_memory_private(const std::filesystem::path& folder);

/// Removes what killed processes of this user left in `folder`: Fast DDS segments and ports that
/// nobody has locked, open or mapped, and data sharing files whose process is gone. Returns how
/// many went.
int clean_shared_memory(const std::filesystem::path& folder);

/// The files that clean_shared_memory() would remove; they stay.
std::vector<std::filesystem::path> left_in_shared_memory(const std::filesystem::path& folder);

}  // namespace armature
