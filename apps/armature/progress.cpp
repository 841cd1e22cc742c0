// SPDX-License-Identifier: Apache-2.0
#include "progress.hpp"

#include <fmt/format.h>
#include <unistd.h>

#include <cstdio>
#include <utility>

namespace armature {
namespace {

constexpr auto kPause = std::chrono::milliseconds{500};

}  // namespace

Progress::Progress(std::string what)
    : what_{std::move(what)},
      terminal_{isatty(STDERR_FILENO) == 1},
      start_{Clock::now()},
      next_{start_ + kPause} {}

Progress::~Progress() {
  if (shown_) std::fputs("\r\033[K", stderr);
}

bool Progress::due() {
  if (!terminal_) return false;
  const auto now = Clock::now();
  if (now < next_) return false;
  next_ = now + kPause;
  return true;
}

void Progress::part(double part) {
  if (due()) show(fmt::format("{:.0f} % of the {}", 100 * part, what_));
}

void Progress::count(std::uint64_t so_far) {
  if (!due()) return;
  const double seconds = std::chrono::duration<double>{Clock::now() - start_}.count();
  show(fmt::format("{} {}, {:.0f} per second", so_far, what_,
                   static_cast<double>(so_far) / seconds));
}

void Progress::of(std::size_t done, std::size_t all) {
  if (!due()) return;
  const double seconds = std::chrono::duration<double>{Clock::now() - start_}.count();
  std::string line = fmt::format("{} of {} {}", done, all, what_);
  if (done > 0) {
    line += fmt::format(", about {:.0f} s left",
                        seconds / static_cast<double>(done) * static_cast<double>(all - done));
  }
  show(line);
}

void Progress::show(const std::string& line) {
  fmt::print(stderr, "\r\033[K{}", line);
  std::fflush(stderr);
  shown_ = true;
}

}  // namespace armature
