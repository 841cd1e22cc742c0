// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <filesystem>
#include <vector>

#include "armature/values/expected.hpp"

namespace armature ARMATURE_EXPORT {

/// What the program that tries a library ends with when the library let it.
inline constexpr int kPluginTried = 42;

/// Has another program load the library `file` first: one that crashes, ends the process or hangs
/// while it is loaded (for longer than `limit`) takes only that one with it. The reason says which.
/// That program shares nothing with this one, is killed with it, and prints nothing. A file that
/// was tried once and has not changed is not tried again.
Expected<void> try_plugin(const std::filesystem::path& file,
                          std::chrono::milliseconds limit = std::chrono::seconds{5});

/// Tries libraries together, which takes little longer than one of them: what they need is loaded
/// once. Says nothing: where it fails, each of them is tried alone when it is loaded.
void try_plugins(const std::vector<std::filesystem::path>& files);

}  // namespace armature
