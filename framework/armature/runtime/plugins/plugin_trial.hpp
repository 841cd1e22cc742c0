// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <filesystem>

#include "armature/values/expected.hpp"

namespace armature {

/// What the program that tries a library ends with when the library let it.
inline constexpr int kPluginTried = 42;

/// Has another program load the library `file` first: one that crashes, ends the process or hangs
/// while it is loaded (for longer than `limit`) takes only that one with it. The reason says which.
/// That program shares nothing with this one, is killed with it, and prints nothing.
Expected<void> try_plugin(const std::filesystem::path& file,
                          std::chrono::milliseconds limit = std::chrono::seconds{5});

}  // namespace armature
