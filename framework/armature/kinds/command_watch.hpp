// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cstdint>
#include <optional>

#include "armature/values/inline_text.hpp"
#include "armature/values/time.hpp"

namespace armature {

/// Tells the driver of an arm when the reference has ceased, so that it brings the arm to rest by
/// itself: no command for `timeout` (one that is stamped ahead of now does not get here). A driver
/// that was late itself judges one period later, since the command that it misses may lie there
/// unread. Counts such stops. Real-time safe.
class CommandWatch {
 public:
  /// `period`: how often `ceased` is asked.
  CommandWatch(Duration timeout, Duration period) : timeout_{timeout}, period_{period} {}

  /// Once per step; `stamp`: of the newest command, if there was one.
  bool ceased(Time now, const std::optional<Time>& stamp) {
    const Duration own = last_ ? now - *last_ - period_ : Duration{0};
    last_ = now;
    if (!stamp) return true;
    const Duration age = now - *stamp;
    const bool too_old = age > timeout_;
    const bool late_itself = own > period_ / 2 && !ceased_ && age - own <= timeout_;
    if (too_old && late_itself) return false;
    if (too_old && !ceased_) {
      ++stops_;
      why_ = ReasonText::format(
          "no command for {:.3f} s (command_timeout_s is {:g}); the driver itself was {:.3f} s "
          "late; stop number {}",
          to_seconds(age), to_seconds(timeout_), to_seconds(std::max(own, Duration{0})), stops_);
    }
    ceased_ = too_old;
    if (!too_old) why_.clear();
    return too_old;
  }

  /// Why the arm was stopped, with the lateness of both sides; empty while commands come.
  const ReasonText& why() const { return why_; }
  std::uint64_t stops() const { return stops_; }

 private:
  Duration timeout_, period_;
  std::optional<Time> last_;
  bool ceased_ = false;
  std::uint64_t stops_ = 0;
  ReasonText why_;
};

}  // namespace armature
