// SPDX-License-Identifier: Apache-2.0
#include "run/watched_end.hpp"

#include <unistd.h>

#include "armature/values/sanitizer.hpp"
#include "exit_code.hpp"
#include "run/ending.hpp"
#include "standard_output.hpp"

namespace armature {

WatchedEnd::WatchedEnd(const RunOptions& options, Console& console, ChildWatch* child)
    : options_{&options}, console_{&console}, child_{child} {
  watch();
}

/// The main process kills another one after 3 s.
void WatchedEnd::watch() {
  const bool is_awaited = child_ && !child_->alone();
  const Duration timeout = seconds((is_awaited ? 2 : 10) * (kSanitized ? 5 : 1));
  watch_.emplace(timeout, [this](const std::string& hung) { leave(hung); });
}

void WatchedEnd::do_unwatched(const std::function<void()>& work) {
  watch_.reset();
  work();
  watch();
}

void WatchedEnd::leave(const std::string& fault) const {
  constexpr unsigned kFileWithin_s = 2;
  if (child_) child_->tell_fault(fault);
  if (!child_ || child_->alone()) console_->tell(fault);
  const std::string told = ending("fault", fault);
  if (options_->json && !result_told_) write_at_once(standard_output_descriptor(), told);
  console_->flush();
  if (options_->report && !child_ && !result_told_) {
    alarm(kFileWithin_s);  // the report's disk may be what hangs
    write_ending(*options_->report, told);
  }
  _exit(kFailed);
}

}  // namespace armature
