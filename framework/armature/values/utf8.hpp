// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>

namespace armature {

/// The character that begins a text, in UTF-8.
struct Utf8Character {
  std::size_t length = 0;  // bytes; 0: they are no character
  std::uint32_t code = 0;
};

/// The first character of `text`, which is not empty. RFC 3629: no overlong forms, no surrogates,
/// at most U+10FFFF.
inline Utf8Character first_character(std::string_view text) {
  const auto byte_at = [&](std::size_t at) -> std::uint32_t {
    return at < text.size() ? static_cast<unsigned char>(text[at]) : 0U;
  };
  const std::uint32_t lead = byte_at(0);
  if (lead < 0x80) return {1, lead};
  const std::size_t length = lead >= 0xF0 ? 4 : lead >= 0xE0 ? 3 : 2;
  if (lead < 0xC2 || lead > 0xF4) return {};
  std::uint32_t code = lead & (0x7FU >> length);
  for (std::size_t i = 1; i < length; ++i) {
    const std::uint32_t next = byte_at(i);
    if ((next & 0xC0U) != 0x80U) return {};
    code = code << 6U | (next & 0x3FU);
  }
  constexpr std::array<std::uint32_t, 5> kSmallest{0, 0, 0x80, 0x800, 0x10000};
  const bool surrogate = code >= 0xD800 && code <= 0xDFFF;
  if (code < kSmallest[length] || code > 0x10FFFF || surrogate) return {};
  return {length, code};
}

/// The first bytes of `text`, at most so many, and no part of a character.
inline std::string_view beginning_of(std::string_view text, std::size_t max_bytes) {
  if (text.size() <= max_bytes) return text;
  std::size_t end = max_bytes;
  while (end > 0 && (static_cast<unsigned char>(text[end]) & 0xC0U) == 0x80U) --end;
  return text.substr(0, end);
}

/// As much of a text that others wrote, of any length, as a message quotes.
inline std::string in_part(std::string_view text) {
  constexpr std::size_t kMaxBytes = 200;
  const std::string_view part = beginning_of(text, kMaxBytes);
  return std::string{part} + (part.size() < text.size() ? "..." : "");
}

/// Whether all of `text` is UTF-8.
inline bool is_utf8(std::string_view text) {
  while (!text.empty()) {
    const std::size_t length = first_character(text).length;
    if (length == 0) return false;
    text.remove_prefix(length);
  }
  return true;
}

}  // namespace armature
