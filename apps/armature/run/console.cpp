// SPDX-License-Identifier: Apache-2.0
#include "run/console.hpp"

#include <fmt/format.h>
#include <unistd.h>

#include <array>

namespace armature {
namespace {

std::string dropped_line(std::uint64_t count) {
  return fmt::format("armature: {} lines are missing here, nobody read them in time", count);
}

}  // namespace

Console::Console() : lines_{STDERR_FILENO, dropped_line} {}

void Console::start(const Clock& clock, Time start) {
  start_ = start;
  clock_.store(&clock, std::memory_order_release);
}

void Console::line(std::string_view who, std::string_view text) {
  const Clock* clock = clock_.load(std::memory_order_acquire);
  const double time = clock ? to_seconds(clock->now() - start_) : 0.0;
  std::array<char, LineWriter::kMaxLine> line;  // NOLINT: filled by what follows
  const auto end =
      fmt::format_to_n(line.data(), line.size(), "[{:7.3f} s] {:<9} {}", time, who, text);
  lines_.put({line.data(), static_cast<std::size_t>(end.out - line.data())});
}

void Console::tell(std::string_view text) { lines_.put(fmt::format("armature: {}", text)); }

std::optional<std::string> Console::lost_reader() const {
  if (lines_.closed() || is_reader_gone(STDERR_FILENO)) return "nobody reads standard error";
  if (is_reader_gone(STDOUT_FILENO)) return "nobody reads standard output";
  return std::nullopt;
}

}  // namespace armature
