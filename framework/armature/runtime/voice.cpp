// SPDX-License-Identifier: Apache-2.0
#include "armature/runtime/voice.hpp"

namespace armature {

void Voice::say(std::string text) {
  {
    const std::scoped_lock lock{mutex_};
    if (text == last_line_) return;
    last_line_ = text;
  }
  if (sink_) sink_(component_, text);
}

void Voice::set(State state, std::string reason) {
  std::string line;
  {
    const std::scoped_lock lock{mutex_};
    if (status_.state == State::fault) return;  // a fault is final
    if (status_.state == state && status_.reason == reason) return;
    const bool was_quiet = status_.state == State::ok && state == State::ok;
    status_ = {state, reason};
    if (was_quiet) return;
    line = state == State::ok ? "ok again" : (state == State::fault ? "FAULT: " : "") + reason;
  }
  if (sink_) sink_(component_, line);
}

Voice::Status Voice::status() const {
  const std::scoped_lock lock{mutex_};
  return status_;
}

}  // namespace armature
