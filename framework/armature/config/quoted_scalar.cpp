// SPDX-License-Identifier: Apache-2.0
#include "armature/config/quoted_scalar.hpp"

#include <charconv>

namespace armature::config {
namespace {

/// True when the escape whose letter and digits `escape` starts with makes a control character
/// other than tab, newline and carriage return.
bool makes_control_character(std::string_view escape) {
  if (escape.empty()) return false;
  if (std::string_view{"0abvfe"}.find(escape.front()) != std::string_view::npos) return true;
  const std::size_t digits = escape.front() == 'x'   ? 2
                             : escape.front() == 'u' ? 4
                             : escape.front() == 'U' ? 8
                                                     : 0;
  const std::string_view hex = escape.substr(1, digits);
  unsigned code = 0;
  const auto [end, error] = std::from_chars(hex.data(), hex.data() + hex.size(), code, 16);
  if (error != std::errc{} || end != hex.data() + hex.size()) return false;
  return (code < 0x20 && code != '\t' && code != '\n' && code != '\r') || code == 0x7F;
}

}  // namespace

std::optional<QuotedFault> fault_of_quoted(std::string_view text) {
  if (text.empty()) return std::nullopt;
  const char quote = text.front();
  for (std::size_t i = 1; i < text.size(); ++i) {
    if (quote == '"' && text[i] == '\\') {
      if (makes_control_character(text.substr(i + 1))) {
        return QuotedFault{i, "an escape that makes a control character"};
      }
      ++i;
    } else if (text[i] == quote) {
      const bool doubled = quote == '\'' && i + 1 < text.size() && text[i + 1] == quote;
      if (!doubled) return std::nullopt;
      ++i;
    }
  }
  return QuotedFault{0, "the quote that opens here is never closed"};
}

}  // namespace armature::config
