// SPDX-License-Identifier: Apache-2.0
#include "armature/laws/law.hpp"

#include <fmt/format.h>

#include <cmath>
#include <utility>

namespace armature {

void LawCheck::asks(std::string question) {
  question_ = std::move(question);
  ++report_.questions;
}

bool LawCheck::that(bool holds, std::string_view claim) {
  return holds || violated(fmt::format("it does not hold that {}", claim));
}

bool LawCheck::at_most(double value, double bound, std::string_view quantity) {
  return value <= bound || violated(fmt::format("{}: {}, more than {}", quantity, value, bound));
}

bool LawCheck::near(double value, double expected, double tolerance, std::string_view quantity) {
  return std::abs(value - expected) <= tolerance ||
         violated(fmt::format("{}: {}, not {} to {}", quantity, value, expected, tolerance));
}

std::string LawCheck::number_text(double value) { return fmt::format("{}", value); }

bool LawCheck::is_not(std::string_view quantity, const std::string& value,
                      const std::string& expected) {
  if (value.empty() && expected.empty())
    return violated(fmt::format("{} is another one", quantity));
  return violated(fmt::format("{}: '{}', not '{}'", quantity, value, expected));
}

bool LawCheck::violated(std::string what) {
  constexpr std::size_t kKept = 5;
  ++report_.failed;
  if (report_.violations.size() < kKept) report_.violations.push_back({std::move(what), question_});
  return false;
}

}  // namespace armature
