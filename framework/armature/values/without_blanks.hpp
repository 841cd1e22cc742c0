// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string_view>

namespace armature {

/// The word without the white space around it.
inline std::string_view without_blanks(std::string_view word) {
  constexpr std::string_view kBlanks = " \t\r\n\v\f";
  const std::size_t first = word.find_first_not_of(kBlanks);
  if (first == std::string_view::npos) return {};
  return word.substr(first, word.find_last_not_of(kBlanks) + 1 - first);
}

}  // namespace armature
