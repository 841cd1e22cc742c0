// SPDX-License-Identifier: Apache-2.0
#include "armature/runtime/component/topic_name.hpp"

#include <fmt/format.h>

#include <algorithm>

namespace armature {
namespace {

bool is_letter(char c) { return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || c == '_'; }
bool is_digit(char c) { return c >= '0' && c <= '9'; }

bool is_word(std::string_view text) {
  return !text.empty() && is_letter(text.front()) &&
         std::all_of(text.begin(), text.end(), [](char c) { return is_letter(c) || is_digit(c); });
}

}  // namespace

std::optional<std::string> topic_name_defect(std::string_view name) {
  std::string_view rest = name.starts_with('/') ? name.substr(1) : name;
  for (;;) {
    const auto slash = rest.find('/');
    if (!is_word(rest.substr(0, slash))) {
      return fmt::format(
          "'{}' names no topic: words of letters, digits and _, not beginning with a digit, with / "
          "between them",
          name);
    }
    if (slash == std::string_view::npos) return std::nullopt;
    rest = rest.substr(slash + 1);
  }
}

}  // namespace armature
