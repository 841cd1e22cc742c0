// SPDX-License-Identifier: Apache-2.0
#include "sweep/variations.hpp"

#include <fmt/format.h>

#include <charconv>
#include <set>
#include <stdexcept>
#include <string_view>

#include "armature/values/without_blanks.hpp"

namespace armature::sweep {
namespace {

constexpr std::uint64_t kMostSeeds = 1'000'000;

/// At the commas outside of brackets and braces.
std::vector<std::string> parts_of(std::string_view text) {
  std::vector<std::string> parts{""};
  int depth = 0;
  for (const char c : text) {
    depth += c == '[' || c == '{';
    depth -= c == ']' || c == '}';
    if (c == ',' && depth == 0) {
      parts.emplace_back();
    } else {
      parts.back() += c;
    }
  }
  return parts;
}

std::uint64_t seed_of(std::string_view text) {
  std::uint64_t seed = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), seed);
  if (error != std::errc{} || end != text.data() + text.size()) {
    throw std::invalid_argument(fmt::format("'{}' is no seed; 1..200 or 1,2,5..9", text));
  }
  return seed;
}

}  // namespace

std::vector<std::uint64_t> seeds_of(const std::string& text) {
  std::vector<std::uint64_t> seeds;
  std::set<std::uint64_t> known;
  for (const std::string& part : parts_of(text)) {
    const auto dots = part.find("..");
    const std::uint64_t first = seed_of(part.substr(0, dots));
    const std::uint64_t last = dots == std::string::npos ? first : seed_of(part.substr(dots + 2));
    if (last < first) throw std::invalid_argument(fmt::format("the range '{}' goes down", part));
    if (last - first >= kMostSeeds - seeds.size()) {
      throw std::invalid_argument(fmt::format("more than {} seeds", kMostSeeds));
    }
    for (std::uint64_t seed = first;; ++seed) {
      if (!known.insert(seed).second) {
        throw std::invalid_argument(fmt::format("seed {} is there twice", seed));
      }
      seeds.push_back(seed);
      if (seed == last) break;
    }
  }
  return seeds;
}

Vary vary_of(const std::string& text) {
  const auto equals = text.find('=');
  if (equals == 0 || equals == std::string::npos || equals + 1 == text.size()) {
    throw std::invalid_argument(fmt::format("'{}' is not key=a,b,c", text));
  }
  const std::string key = text.substr(0, equals);
  if (key == "seed" || key == "clock") {
    throw std::invalid_argument(fmt::format("a sweep sets '{}' itself; see --seeds", key));
  }
  Vary vary{key, parts_of(text.substr(equals + 1))};
  if (std::set<std::string>(vary.values.begin(), vary.values.end()).size() != vary.values.size()) {
    throw std::invalid_argument(fmt::format("'{}' has a value twice", text));
  }
  return vary;
}

void check_assignment(const std::string& text) {
  const auto equals = text.find('=');
  if (equals == std::string::npos) return;
  const auto key = without_blanks(std::string_view{text}.substr(0, equals));
  const auto value = without_blanks(std::string_view{text}.substr(equals + 1));
  if (key == "seed") {
    throw std::invalid_argument(
        fmt::format("'{}': a sweep sets the seed itself; say which with --seeds {}", text, value));
  }
  if (key == "clock" && value != "simulated") {
    throw std::invalid_argument(
        fmt::format("'{}': a sweep runs in lockstep on the simulated clock; leave it out, or run "
                    "the deployment by itself: armature run",
                    text));
  }
}

std::vector<std::vector<std::string>> combinations(const std::vector<Vary>& vary) {
  std::vector<std::vector<std::string>> all{{}};
  std::set<std::string> keys;
  for (const Vary& one : vary) {
    if (!keys.insert(one.key).second) {
      throw std::invalid_argument(fmt::format("'{}' is varied twice", one.key));
    }
    std::vector<std::vector<std::string>> longer;
    for (const auto& before : all) {
      for (const std::string& value : one.values) {
        longer.push_back(before);
        longer.back().push_back(one.key + "=" + value);
      }
    }
    all = std::move(longer);
  }
  return all;
}

}  // namespace armature::sweep
