// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <string>
#include <string_view>

#include "armature/values/expected.hpp"

namespace armature {

/// What gzip compressed, at most `max_bytes` of it: a small file can claim to be a huge one.
/// Refuses what is not gzip, damaged, or ends too early.
Expected<std::string> inflated(std::string_view gzip, std::size_t max_bytes);

}  // namespace armature
