// SPDX-License-Identifier: Apache-2.0
#include "armature/config/environment.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cstdlib>
#include <optional>

#include "armature/values/utf8.hpp"

namespace armature::config {
namespace {

constexpr std::string_view kSpecial = "{},:#[]";
constexpr std::string_view kMasked = "\x01\x02\x03\x04\x05\x06\x07";
constexpr char kOpen = '\x01';
constexpr char kClose = '\x02';

char exchanged(char c, std::string_view from, std::string_view to) {
  const std::size_t at = from.find(c);
  return at == std::string_view::npos ? c : to[at];
}

bool is_variable_name(std::string_view name) {
  const auto is_letter = [](char c) {
    return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || c == '_';
  };
  return !name.empty() && is_letter(name.front()) &&
         std::ranges::all_of(name, [&](char c) { return is_letter(c) || (c >= '0' && c <= '9'); });
}

/// Whether a file may say it, too.
bool is_text(std::string_view value) {
  return is_utf8(value) && std::ranges::none_of(value, [](unsigned char c) {
           return (c < 0x20 && c != '\t' && c != '\n') || c == 0x7F;
         });
}

/// The value of one `NAME` or `NAME:-default`; none when a problem was noted.
std::optional<std::string> value_of(const std::string& inside, const Origin& origin,
                                    Problems& problems) {
  const std::size_t dash = inside.find(":-");
  const std::string name = inside.substr(0, dash);
  const bool nested = inside.find("${") != std::string::npos;
  if (!is_variable_name(name) || nested) {
    problems.add(origin, fmt::format("{} is neither ${{NAME}} nor ${{NAME:-default}}; in single "
                                     "quotes it stays as it is written",
                                     in_quotes("${" + inside + "}")));
    return std::nullopt;
  }
  const char* value = std::getenv(name.c_str());
  if (value && !is_text(value)) {
    problems.add(origin, fmt::format("the environment variable '{}' is no UTF-8, or has a control "
                                     "character",
                                     name));
    return std::nullopt;
  }
  if (dash == std::string::npos) {
    if (value) return value;
    problems.add(origin, fmt::format("the environment variable '{0}' is not set; set it or write "
                                     "${{{0}:-default}}",
                                     name));
    return std::nullopt;
  }
  return value && *value ? std::string{value} : inside.substr(dash + 2);
}

}  // namespace

std::string mask_variables(std::string text) {
  std::size_t unclosed_until = 0;
  for (std::size_t at = text.find("${"); at != std::string::npos; at = text.find("${", at + 2)) {
    text[at + 1] = kOpen;
    if (at < unclosed_until) continue;
    const std::size_t end = std::min(text.find_first_of("}\n", at), text.size());
    if (end == text.size() || text[end] == '\n') {
      unclosed_until = end;
      continue;
    }
    for (std::size_t i = at + 2; i <= end; ++i) text[i] = exchanged(text[i], kSpecial, kMasked);
    at = end - 1;
  }
  return text;
}

std::string unmask(std::string_view masked) {
  std::string text{masked};
  for (char& c : text) c = exchanged(c, kMasked, kSpecial);
  return text;
}

std::string expand_variables(std::string_view masked, const Origin& origin, Problems& problems) {
  std::string text;
  while (true) {
    const std::size_t open = masked.find(kOpen);
    if (open == std::string_view::npos || open == 0) break;
    text += unmask(masked.substr(0, open - 1));
    const std::size_t close = masked.find(kClose, open);
    if (close == std::string_view::npos) {
      problems.add(origin,
                   "'${' is not closed by '}' on its line; in single quotes it stays as it "
                   "is written");
      return text;
    }
    const auto value =
        value_of(unmask(masked.substr(open + 1, close - open - 1)), origin, problems);
    text += value.value_or("");
    masked.remove_prefix(close + 1);
  }
  return text + unmask(masked);
}

}  // namespace armature::config
