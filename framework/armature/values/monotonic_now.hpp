// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>

#include "armature/values/time.hpp"

namespace armature {

/// An instant of the monotonic clock, which nobody sets.
inline Time monotonic_now() {
  return Time{Duration{std::chrono::steady_clock::now().time_since_epoch()}.count()};
}

}  // namespace armature
