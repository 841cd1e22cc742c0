// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>

#include "armature/values/utf8.hpp"

namespace armature {

/// Whether a terminal obeys a character and does not show it: control characters of ISO 6429, and
/// those of Unicode that break lines or turn the direction of writing (UAX 9).
bool is_obeyed(std::uint32_t code);

/// Calls `put(piece)` with `text` as `terminal_text` has it, a character or a byte at a time.
/// Real-time safe when `put` is.
template <class Put>
void for_each_shown(std::string_view text, const Put& put) {
  constexpr std::string_view kDigits = "0123456789abcdef";
  while (!text.empty()) {
    const auto [length, code] = first_character(text);
    const std::string_view bytes = text.substr(0, std::max<std::size_t>(length, 1));
    text.remove_prefix(bytes.size());
    if (length > 0 && !is_obeyed(code)) {
      put(bytes);
      continue;
    }
    for (const char byte : bytes) {
      const auto value = static_cast<unsigned char>(byte);
      const char shown[] = {'\\', 'x', kDigits[value >> 4U], kDigits[value & 0xFU]};
      put(std::string_view{shown, sizeof shown});
    }
  }
}

/// The text that somebody else wrote, as one line that a terminal shows and does not obey: control
/// characters, line ends, marks that turn the direction of writing, and bytes that are no UTF-8 as
/// `\x1b`; all else as it is.
std::string terminal_text(std::string_view text);

/// The same of a text of several lines; all but the first one begin with `indent` blanks, so that
/// none looks as if somebody else had said it.
std::string terminal_lines(std::string_view text, std::size_t indent);

}  // namespace armature
