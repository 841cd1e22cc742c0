// SPDX-License-Identifier: Apache-2.0
#include "terminal_text.hpp"

#include <array>

namespace armature {

bool is_obeyed(std::uint32_t code) {
  struct Range {
    std::uint32_t first, last;
  };
  constexpr std::array<Range, 7> kRanges{{{0x00, 0x1F},
                                          {0x7F, 0x9F},
                                          {0x061C, 0x061C},
                                          {0x200E, 0x200F},
                                          {0x2028, 0x202E},
                                          {0x2066, 0x2069},
                                          {0xFEFF, 0xFEFF}}};
  return std::ranges::any_of(
      kRanges, [&](const Range& range) { return code >= range.first && code <= range.last; });
}

std::string terminal_text(std::string_view text) {
  std::string shown;
  for_each_shown(text, [&](std::string_view piece) { shown += piece; });
  return shown;
}

std::string terminal_lines(std::string_view text, std::size_t indent) {
  while (text.ends_with('\n')) text.remove_suffix(1);
  std::string shown;
  for (std::size_t end = text.find('\n'); end != std::string_view::npos; end = text.find('\n')) {
    shown += terminal_text(text.substr(0, end)) + '\n' + std::string(indent, ' ');
    text.remove_prefix(end + 1);
  }
  return shown + terminal_text(text);
}

}  // namespace armature
