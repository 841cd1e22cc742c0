// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cctype>
#include <optional>
#include <vector>

#include "armature/config/problems.hpp"
#include "armature/config/unit_suffix.hpp"

namespace armature::config {
namespace {

constexpr std::size_t kLongestGuess = 64;
constexpr std::size_t kMaxSuggestions = 3;
constexpr std::size_t kMaxKnown = 8;

std::string lower(std::string_view text) {
  std::string result{text};
  std::ranges::transform(result, result.begin(),
                         [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return result;
}

/// Insertions, deletions, replacements and swaps of neighbours (optimal string alignment).
std::size_t edit_distance(std::string_view a, std::string_view b) {
  std::vector<std::vector<std::size_t>> cost(a.size() + 1, std::vector<std::size_t>(b.size() + 1));
  for (std::size_t i = 0; i <= a.size(); ++i) {
    for (std::size_t j = 0; j <= b.size(); ++j) {
      if (i == 0 || j == 0) {
        cost[i][j] = i + j;
        continue;
      }
      const std::size_t replaced = cost[i - 1][j - 1] + (a[i - 1] == b[j - 1] ? 0 : 1);
      cost[i][j] = std::min({cost[i - 1][j] + 1, cost[i][j - 1] + 1, replaced});
      if (i > 1 && j > 1 && a[i - 1] == b[j - 2] && a[i - 2] == b[j - 1]) {
        cost[i][j] = std::min(cost[i][j], cost[i - 2][j - 2] + 1);
      }
    }
  }
  return cost[a.size()][b.size()];
}

/// How far `known` is from what was written; none: not near enough to be meant.
std::optional<std::size_t> nearness(const std::string& wrong, const std::string& known) {
  if (known.size() > kLongestGuess) return std::nullopt;
  if (without_unit(wrong) == without_unit(known)) return 0;
  if (known.ends_with("/" + wrong) || wrong.ends_with("/" + known)) return 0;
  const std::size_t distance = edit_distance(wrong, known);
  const std::size_t threshold = std::max<std::size_t>(2, wrong.size() / 3);
  const bool half_the_same = 2 * distance <= std::max(wrong.size(), known.size());
  if (distance <= threshold && half_the_same) return distance;
  if (wrong.size() >= 4 && known.starts_with(wrong)) return threshold + 1;
  return std::nullopt;
}

std::vector<std::string> nearest(std::string_view wrong, std::span<const std::string> known) {
  std::vector<std::string> best;
  if (wrong.empty() || wrong.size() > kLongestGuess) return best;
  const std::string guess = lower(wrong);
  std::size_t best_distance = kLongestGuess;
  for (const std::string& name : known) {
    const auto distance = nearness(guess, lower(name));
    if (!distance || *distance > best_distance) continue;
    if (*distance < best_distance) best.clear();
    best_distance = *distance;
    if (std::ranges::find(best, name) == best.end()) best.push_back(name);
  }
  if (best.size() > kMaxSuggestions) best.resize(kMaxSuggestions);
  return best;
}

}  // namespace

std::string spelling_hint(std::string_view wrong, std::span<const std::string> known) {
  const std::vector<std::string> near = nearest(wrong, known);
  return near.empty() ? "" : fmt::format("; did you mean '{}'?", fmt::join(near, "' or '"));
}

std::string did_you_mean(std::string_view wrong, std::span<const std::string> known) {
  if (std::string hint = spelling_hint(wrong, known); !hint.empty() || known.empty()) return hint;
  const auto shown = known.first(std::min(known.size(), kMaxKnown));
  return fmt::format("; known: {}{}", fmt::join(shown, ", "),
                     shown.size() < known.size() ? ", ..." : "");
}

}  // namespace armature::config
