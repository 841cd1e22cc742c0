// SPDX-License-Identifier: Apache-2.0
#include "run/console.hpp"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <array>

#include "standard_output.hpp"
#include "terminal_text.hpp"

namespace armature {
namespace {

std::string dropped_line(std::uint64_t count) {
  return fmt::format(
      "armature: {} lines are missing here: nobody read them in time, or there was no room for "
      "them",
      count);
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
  char* const end = line.data() + line.size();
  char* at = fmt::format_to_n(line.data(), line.size(), "[{:7.3f} s] {:<9} ", time, who).out;
  const std::size_t indent = static_cast<std::size_t>(at - line.data());
  for_each_shown(text, [&](std::string_view piece) {
    if (piece != "\\x0a") {
      at =
          std::copy_n(piece.data(), std::min(piece.size(), static_cast<std::size_t>(end - at)), at);
      return;
    }
    if (at < end) *at++ = '\n';
    at = std::fill_n(at, std::min(indent, static_cast<std::size_t>(end - at)), ' ');
  });
  lines_.put({line.data(), static_cast<std::size_t>(at - line.data())});
}

void Console::tell(std::string_view text) { lines_.put(fmt::format("armature: {}", text)); }

std::optional<std::string> Console::lost_reader() const {
  if (lines_.closed() || is_reader_gone(STDERR_FILENO)) return "nobody reads standard error";
  if (is_reader_gone(standard_output_descriptor())) return "nobody reads standard output";
  return std::nullopt;
}

}  // namespace armature
