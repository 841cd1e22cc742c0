// SPDX-License-Identifier: Apache-2.0
#include "armature/config/problems.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <set>
#include <tuple>
#include <utility>

namespace armature::config {
namespace {

std::string joined(const std::vector<Problem>& problems) {
  std::string text;
  for (const Problem& problem : problems) {
    if (!text.empty()) text += '\n';
    text += problem.text();
  }
  return text;
}

}  // namespace

std::string Problem::text() const {
  const std::string place = origin.text();
  return place.empty() ? message : place + ": " + message;
}

void Problems::add(const Origin& origin, std::string message) {
  problems_.push_back({origin, std::move(message)});
}

std::vector<Problem> Problems::sorted() const {
  std::map<std::string, std::size_t> file_rank;
  std::set<std::tuple<std::string, int, int, std::string>> seen;
  std::vector<Problem> sorted;
  for (const Problem& problem : problems_) {
    const Origin& origin = problem.origin;
    file_rank.emplace(origin.file, file_rank.size());
    if (seen.emplace(origin.file, origin.line, origin.column, problem.message).second) {
      sorted.push_back(problem);
    }
  }
  std::ranges::stable_sort(sorted, {}, [&](const Problem& problem) {
    const Origin& origin = problem.origin;
    return std::tuple{file_rank.at(origin.file), origin.line, origin.column};
  });
  return sorted;
}

void Problems::throw_if_any() const {
  if (!problems_.empty()) throw ConfigError{sorted()};
}

ConfigError::ConfigError(std::vector<Problem> problems)
    : std::runtime_error{joined(problems)}, problems_{std::move(problems)} {}

std::string in_quotes(std::string_view text) {
  constexpr std::size_t kLongest = 60;
  std::string shown = "'";
  std::size_t characters = 0;
  for (const char c : text) {
    const auto byte = static_cast<unsigned char>(c);
    const bool starts_character = (byte & 0xC0) != 0x80;
    if (starts_character && ++characters > kLongest) {
      shown += "...";
      break;
    }
    if (c == '\n') {
      shown += "\\n";
    } else if (byte < 0x20 || byte == 0x7F) {
      shown += fmt::format("\\x{:02x}", byte);
    } else {
      shown += c;
    }
  }
  return shown + "'";
}

}  // namespace armature::config
