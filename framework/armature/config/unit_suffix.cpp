// SPDX-License-Identifier: Apache-2.0
#include "armature/config/unit_suffix.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <numbers>
#include <vector>

namespace armature::config {
namespace {

constexpr double kDegree = std::numbers::pi / 180;
constexpr double kMilli = 1e-3;

/// All that a file may state.
constexpr std::array kUnits{
    UnitSuffix{"m", 1, "m"},           UnitSuffix{"mm", kMilli, "m"},
    UnitSuffix{"m_s", 1, "m_s"},       UnitSuffix{"mm_s", kMilli, "m_s"},
    UnitSuffix{"m_s2", 1, "m_s2"},     UnitSuffix{"mm_s2", kMilli, "m_s2"},
    UnitSuffix{"m_s3", 1, "m_s3"},     UnitSuffix{"mm_s3", kMilli, "m_s3"},
    UnitSuffix{"rad", 1, "rad"},       UnitSuffix{"deg", kDegree, "rad"},
    UnitSuffix{"rad_s", 1, "rad_s"},   UnitSuffix{"deg_s", kDegree, "rad_s"},
    UnitSuffix{"rad_s2", 1, "rad_s2"}, UnitSuffix{"deg_s2", kDegree, "rad_s2"},
    UnitSuffix{"rad_s3", 1, "rad_s3"}, UnitSuffix{"deg_s3", kDegree, "rad_s3"},
    UnitSuffix{"s", 1, "s"},           UnitSuffix{"ms", kMilli, "s"},
    UnitSuffix{"hz", 1, "hz"},         UnitSuffix{"px", 1, "px"},
    UnitSuffix{"db", 1, "db"},         UnitSuffix{"kg", 1, "kg"},
    UnitSuffix{"kg_m2", 1, "kg_m2"},
};

/// Words that are part of a unit, whether it is read here or not.
constexpr std::array<std::string_view, 26> kUnitWords{
    "m",   "m2", "mm",  "cm",  "km",  "um",   "inch", "s",  "s2",  "s3",  "ms", "us", "ns",
    "min", "hz", "khz", "mhz", "rad", "mrad", "deg",  "px", "rpm", "rps", "kg", "nm", "db"};

bool is_unit_word(std::string_view word) {
  return std::ranges::find(kUnitWords, word) != kUnitWords.end();
}

/// The words of units at the end of `key`, at least one other word before them: "deg_s" of
/// "max_rate_deg_s"; empty: none.
std::string_view unit_words(std::string_view key) {
  std::size_t begin = key.size();
  while (true) {
    const std::string_view before = key.substr(0, begin == key.size() ? begin : begin - 1);
    const std::size_t underline = before.rfind('_');
    const bool is_first = underline == std::string_view::npos || underline == 0;
    if (is_first || !is_unit_word(before.substr(underline + 1))) return key.substr(begin);
    begin = underline + 1;
  }
}

}  // namespace

const UnitSuffix* unit_of(std::string_view key) {
  const auto unit = std::ranges::find(kUnits, unit_words(key), &UnitSuffix::written);
  return unit == kUnits.end() ? nullptr : &*unit;
}

std::string_view without_unit(std::string_view key) {
  if (const auto words = unit_words(key); !words.empty()) key.remove_suffix(words.size() + 1);
  return key;
}

double si_factor(std::string_view key) {
  const UnitSuffix* unit = unit_of(key);
  return unit ? unit->to_si : 1;
}

std::string unknown_unit(std::string_view key) {
  const std::string_view words = unit_words(key);
  if (words.empty() || unit_of(key)) return "";
  std::vector<std::string_view> known;
  for (const UnitSuffix& unit : kUnits) known.push_back(unit.written);
  return fmt::format("'_{}' is no unit that is read here; these are: {}", words,
                     fmt::join(known, ", "));
}

}  // namespace armature::config
