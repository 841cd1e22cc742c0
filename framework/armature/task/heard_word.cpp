// SPDX-License-Identifier: Apache-2.0
#include "armature/task/heard_word.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cstddef>
#include <iterator>
#include <string_view>

#include "armature/values/utf8.hpp"

namespace armature {
namespace {

std::string first_letters(std::string_view text) {
  constexpr std::size_t kLetters = 64;
  std::string_view rest = text;
  for (std::size_t i = 0; i < kLetters && !rest.empty(); ++i) {
    rest.remove_prefix(std::max<std::size_t>(first_character(rest).length, 1));
  }
  if (rest.empty()) return std::string{text};
  return std::string{text.substr(0, text.size() - rest.size())} + "...";
}

}  // namespace

OperatorCommand heard_word(const msg::OperatorCommand& message) {
  return {.id = message.command_id_(),
          .word = first_letters(message.command_()),
          .step = first_letters(message.step_())};
}

Expected<void> in_time(const std::string& word, Time stamp, Time now) {
  const bool is_none = std::ranges::find(kOperatorWords, word) == std::end(kOperatorWords);
  if (is_none || makes_safe(word)) return {};
  if (stamp == Time{}) {
    return refuse(
        fmt::format("'{}' has no time, so that it may be an old one: say it with armature "
                    "operator, or write the time of now to header.stamp",
                    word));
  }
  const double age_s = to_seconds(now - stamp), holds_s = to_seconds(kWordHolds);
  if (age_s > holds_s) {
    return refuse(
        fmt::format("'{}' was said {:.1f} s ago, and holds for {:g} s: say it again; when it "
                    "is new, the clock of its host is behind",
                    word, age_s, holds_s));
  }
  if (age_s < -holds_s) {
    return refuse(
        fmt::format("'{}' is stamped {:.1f} s ahead of now, and {:g} s are allowed: set the "
                    "clock of its host",
                    word, -age_s, holds_s));
  }
  return {};
}

}  // namespace armature
