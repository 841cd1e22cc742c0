// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>

#include "armature/values/time.hpp"

namespace armature ARMATURE_EXPORT {

/// Says when something is due that happens at a rate, in a component that may be activated more
/// often than that: by its executor's period, by triggers, or for something quicker. Real-time
/// safe.
class RateLimiter {
 public:
  explicit RateLimiter(Duration period) : period_{period} {}

  /// True once in every period; what was missed is not caught up. An activation counts for the
  /// limiter that it is up to half a period early for, so that the beats of a late one are not
  /// skipped.
  bool due(Time now) {
    if (!next_) next_ = now;
    if (now < *next_ - period_ / 2) return false;
    next_ = (now < *next_ + period_ ? *next_ : now) + period_;
    return true;
  }

 private:
  Duration period_;
  std::optional<Time> next_;
};

}  // namespace armature
