// SPDX-License-Identifier: Apache-2.0
#include "colour.hpp"

#include <fmt/color.h>
#include <unistd.h>

#include <cstdlib>

namespace armature {
namespace {

bool shows_colours(std::FILE* stream) {
  const char* off = std::getenv("NO_COLOR");
  const char* terminal = std::getenv("TERM");
  return (off == nullptr || *off == '\0') && terminal != nullptr &&
         std::string_view{terminal} != "dumb" && isatty(fileno(stream)) == 1;
}

fmt::terminal_color colour_of(Tone tone) {
  switch (tone) {
    case Tone::good: return fmt::terminal_color::green;
    case Tone::doubtful: return fmt::terminal_color::yellow;
    case Tone::bad: break;
  }
  return fmt::terminal_color::red;
}

}  // namespace

std::string coloured(std::string_view text, Tone tone, std::FILE* stream) {
  if (!shows_colours(stream)) return std::string{text};
  return fmt::format(fmt::fg(colour_of(tone)), "{}", text);
}

}  // namespace armature
