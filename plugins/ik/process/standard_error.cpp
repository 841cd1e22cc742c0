// SPDX-License-Identifier: Apache-2.0
#include "standard_error.hpp"

#include <fmt/format.h>
#include <poll.h>
#include <unistd.h>

#include <algorithm>
#include <climits>
#include <cstddef>

namespace armature::ik::process {
namespace {

constexpr std::size_t kAtOnce = PIPE_BUF;  // [byte] that a pipe with room takes without waiting
constexpr std::size_t kLongestName = 1000;

bool has_room() {
  pollfd state{.fd = STDERR_FILENO, .events = POLLOUT, .revents = 0};
  return poll(&state, 1, 0) > 0 && (state.revents & POLLOUT) != 0;
}

}  // namespace

StandardError::StandardError(std::string name) : name_{std::move(name)} {
  name_.resize(std::min(name_.size(), kLongestName));
}

void StandardError::put(std::string_view line) {
  const std::size_t longest = kAtOnce - name_.size() - std::string_view{": \n"}.size();
  do {
    tell_dropped();
    if (dropped_ > 0 || !write_at_once(line.substr(0, longest))) ++dropped_;
    line.remove_prefix(std::min(line.size(), longest));
  } while (!line.empty());
}

void StandardError::tell_dropped() {
  if (dropped_ == 0) return;
  if (write_at_once(fmt::format("{} lines were dropped: nobody has read them", dropped_))) {
    dropped_ = 0;
  }
}

/// In one piece, so that lines of several writers stay apart. False: there is no room.
bool StandardError::write_at_once(std::string_view line) const {
  if (!has_room()) return false;
  const std::string text = fmt::format("{}: {}\n", name_, line);
  return write(STDERR_FILENO, text.data(), text.size()) == static_cast<ssize_t>(text.size());
}

}  // namespace armature::ik::process
