// SPDX-License-Identifier: Apache-2.0
#include "armature/config/reader.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "armature/config/conversion.hpp"

namespace armature::config {
namespace {

template <class T>
std::optional<T> noted(Converted<T> converted, Problems& problems, const std::string& name = "") {
  if (converted) return std::move(*converted);
  problems.add(converted.error().origin, name + converted.error().message);
  return std::nullopt;
}

std::string named(std::string_view key) { return in_quotes(key) + " "; }

}  // namespace

std::optional<double> as_number(const Node& node, Problems& problems) {
  return noted(to_number(node), problems);
}

std::optional<std::int64_t> as_integer(const Node& node, Problems& problems) {
  return noted(to_integer(node), problems);
}

std::optional<bool> as_flag(const Node& node, Problems& problems) {
  return noted(to_flag(node), problems);
}

std::optional<std::string> as_text(const Node& node, Problems& problems) {
  return noted(to_text(node), problems);
}

std::optional<std::vector<double>> as_numbers(const Node& node, Problems& problems) {
  return noted(to_numbers(node, std::nullopt), problems);
}

MapReader::MapReader(const Node& node, std::string what, Problems& problems)
    : node_{node}, what_{std::move(what)}, problems_{problems} {
  if (node_.kind() != Node::Kind::map) {
    problems_.add(node_.origin(), fmt::format("{} must be a map, not {}", what_, node_.describe()));
  }
}

const Node* MapReader::look(std::string_view key) {
  asked_.emplace(key);
  return node_.find(key);
}

const Node* MapReader::node(std::string_view key) {
  const Node* value = look(key);
  if (!value && node_.kind() == Node::Kind::map) {
    problems_.add(node_.origin(), fmt::format("missing key {} in {}", in_quotes(key), what_));
  }
  return value;
}

const Node* MapReader::optional_node(std::string_view key) { return look(key); }

double MapReader::number(std::string_view key) {
  const Node* value = node(key);
  return value ? noted(to_number(*value), problems_, named(key)).value_or(0.0) : 0.0;
}

std::string MapReader::text(std::string_view key) {
  const Node* value = node(key);
  return value ? noted(to_text(*value), problems_, named(key)).value_or("") : "";
}

std::vector<double> MapReader::numbers(std::string_view key, std::size_t count) {
  const Node* value = node(key);
  std::vector<double> zeros(count, 0.0);
  return value ? noted(to_numbers(*value, count), problems_, named(key)).value_or(zeros) : zeros;
}

double MapReader::number(std::string_view key, double fallback) {
  const Node* value = look(key);
  return value ? noted(to_number(*value), problems_, named(key)).value_or(fallback) : fallback;
}

std::int64_t MapReader::integer(std::string_view key, std::int64_t fallback) {
  const Node* value = look(key);
  return value ? noted(to_integer(*value), problems_, named(key)).value_or(fallback) : fallback;
}

std::uint64_t MapReader::natural(std::string_view key, std::uint64_t fallback) {
  const Node* value = look(key);
  return value ? noted(to_natural(*value), problems_, named(key)).value_or(fallback) : fallback;
}

bool MapReader::flag(std::string_view key, bool fallback) {
  const Node* value = look(key);
  return value ? noted(to_flag(*value), problems_, named(key)).value_or(fallback) : fallback;
}

std::string MapReader::text(std::string_view key, std::string fallback) {
  const Node* value = look(key);
  return value ? noted(to_text(*value), problems_, named(key)).value_or(fallback) : fallback;
}

std::string MapReader::choice(std::string_view key, const std::vector<std::string>& allowed,
                              std::string fallback) {
  const Node* value = look(key);
  if (!value) return fallback;
  const auto text = noted(to_text(*value), problems_, named(key));
  if (!text) return fallback;
  if (std::ranges::find(allowed, *text) != allowed.end()) return *text;
  problems_.add(value->origin(), fmt::format("{} cannot be {}{}", in_quotes(key), in_quotes(*text),
                                             did_you_mean(*text, allowed)));
  return fallback;
}

std::optional<std::vector<double>> MapReader::optional_numbers(std::string_view key,
                                                               std::size_t count) {
  const Node* value = look(key);
  if (!value) return std::nullopt;
  return noted(to_numbers(*value, count), problems_, named(key));
}

void MapReader::problem(std::string_view key, std::string message) {
  const Node* value = look(key);
  problems_.add(value ? value->origin() : node_.origin(), std::move(message));
}

void MapReader::finish() {
  const std::vector<std::string> known{asked_.begin(), asked_.end()};
  for (const Node::Entry& entry : node_.entries()) {
    if (asked_.contains(entry.key)) continue;
    problems_.add(entry.key_origin, fmt::format("unknown key {} in {}{}", in_quotes(entry.key),
                                                what_, did_you_mean(entry.key, known)));
  }
}

}  // namespace armature::config
