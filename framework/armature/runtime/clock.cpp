// SPDX-License-Identifier: Apache-2.0
#include "armature/runtime/clock.hpp"

#include <chrono>

namespace armature {

SystemClock::SystemClock()
    : unix_minus_monotonic_{std::chrono::system_clock::now().time_since_epoch() -
                            std::chrono::steady_clock::now().time_since_epoch()} {}

Time SystemClock::now() const {
  const Duration monotonic = std::chrono::steady_clock::now().time_since_epoch();
  return {(monotonic + unix_minus_monotonic_).count()};
}

}  // namespace armature
