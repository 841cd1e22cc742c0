// SPDX-License-Identifier: Apache-2.0
#include "armature/runtime/component/status_reporter.hpp"

#include <mutex>
#include <utility>

#include "armature/values/inline_text.hpp"

namespace armature {
namespace {

using Line = InlineText<StatusReporter::kMaxText>;

Line line_of(StatusReporter::State state, std::string_view reason) {
  if (state == StatusReporter::State::ok) return "ok again";
  if (state == StatusReporter::State::fault) return Line::format("FAULT: {}", reason);
  return reason;
}

}  // namespace

StatusReporter::StatusReporter(std::string component, Sink sink)
    : component_{std::move(component)}, sink_{std::move(sink)} {
  last_line_.reserve(kMaxText);
  status_.reason.reserve(kMaxText);
}

void StatusReporter::log(std::string_view text) {
  text = text.substr(0, kMaxText);
  {
    const std::scoped_lock lock{mutex_};
    if (text == last_line_) return;
    last_line_.assign(text);
  }
  if (sink_) sink_(component_, text, State::ok);
}

void StatusReporter::set(State state, std::string_view reason) {
  reason = reason.substr(0, kMaxText);
  {
    const std::scoped_lock lock{mutex_};
    if (status_.state == State::fault) return;  // a fault is final
    if (status_.state == state && status_.reason == reason) return;
    const bool was_quiet = status_.state == State::ok && state == State::ok;
    status_.state = state;
    status_.reason.assign(reason);
    if (was_quiet || (quiet_ && state != State::fault)) return;
  }
  if (sink_) sink_(component_, line_of(state, reason), state);
}

void StatusReporter::keep_to_itself(bool quiet) {
  const std::scoped_lock lock{mutex_};
  quiet_ = quiet;
}

StatusReporter::Status StatusReporter::status() const {
  const std::scoped_lock lock{mutex_};
  return status_;
}

}  // namespace armature
