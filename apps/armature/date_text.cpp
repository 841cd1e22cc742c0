// SPDX-License-Identifier: Apache-2.0
#include "date_text.hpp"

#include <array>

namespace armature {

std::tm utc(std::time_t time) {
  std::tm date{};
  gmtime_r(&time, &date);
  return date;
}

std::string date_text(const std::tm& date, const char* format) {
  std::array<char, 64> text;  // NOLINT: filled by strftime
  return {text.data(), std::strftime(text.data(), text.size(), format, &date)};
}

}  // namespace armature
