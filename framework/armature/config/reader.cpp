// SPDX-License-Identifier: Apache-2.0
#include "armature/config/reader.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <stdexcept>
#include <utility>

#include "armature/config/document.hpp"

namespace armature::config {

using Type = KeySpec::Type;

std::optional<std::string> as_text(const Node& node, Problems& problems) {
  auto text = to_text(node);
  if (text) return std::move(*text);
  problems.add(text.error().origin, text.error().message);
  return std::nullopt;
}

MapReader::MapReader(const Node& node, std::string what, std::span<const KeySpec> table,
                     Problems& problems)
    : MapReader{node, std::move(what), problems} {
  table_ = table;
}

MapReader::MapReader(const Node& node, std::string what, Problems& problems)
    : node_{node}, what_{std::move(what)}, problems_{problems} {
  if (node_.kind() != Node::Kind::map) {
    problems_.add(node_.origin(), fmt::format("{} must be a map, not {}", what_, node_.describe()));
  }
}

/// The key's row; `types`: what it may be there, the first of them what it is without a table.
KeySpec MapReader::spec_of(std::string_view key, std::initializer_list<Type> types) {
  keys_read_.emplace(key);
  if (!table_) return {.name = std::string{key}, .type = *types.begin()};
  const auto row = std::ranges::find(*table_, key, &KeySpec::name);
  if (row == table_->end()) {
    throw std::logic_error{fmt::format("the table of {} has no key {}", what_, in_quotes(key))};
  }
  const bool is_any = *types.begin() == Type::section;
  if (is_any || std::ranges::find(types, row->type) != types.end()) return *row;
  throw std::logic_error{
      fmt::format("key {} of {} is asked for as another type", in_quotes(key), what_)};
}

/// The value as written; what is written twice, in two units, is a problem.
const Node* MapReader::find(const KeySpec& key, std::string_view* written) {
  const Node* node = node_.find(key.name);
  const Node* other = key.also.empty() ? nullptr : node_.find(key.also);
  if (node && other) {
    problems_.add(other->origin(), fmt::format("{} and {} state the same; keep one",
                                               in_quotes(key.name), in_quotes(key.also)));
  }
  if (written) *written = !node && other ? key.also : key.name;
  return node ? node : other;
}

MapReader::Reading MapReader::read(const KeySpec& key) {
  keys_read_.insert(key.name);
  std::string_view name;
  Reading reading{.node = find(key, &name)};
  reading.is_written = reading.node != nullptr;
  if (!reading.node && key.fallback) reading.node = &*key.fallback;
  if (!reading.node) {
    if (!key.optional && node_.kind() == Node::Kind::map) {
      problems_.add(node_.origin(),
                    fmt::format("missing key {} in {}", in_quotes(key.name), what_));
    }
    return reading;
  }
  const std::string folder = reading.is_written ? folder_of(reading.node->origin()).string() : "";
  auto value = to_value(key, name, *reading.node, folder);
  if (value) {
    reading.value = std::move(*value);
  } else {
    problems_.add(value.error().origin, in_quotes(name) + " " + value.error().message);
  }
  return reading;
}

template <class T>
std::optional<T> MapReader::get(const KeySpec& key) {
  auto value = read(key).value;
  if (!value && key.fallback) {
    if (auto usual = to_value(key, key.name, *key.fallback, "")) value = std::move(*usual);
  }
  return value ? std::optional<T>{std::get<T>(std::move(*value))} : std::nullopt;
}

double MapReader::number(std::string_view key) { return optional_number(key).value_or(0); }

std::int64_t MapReader::integer(std::string_view key) { return optional_integer(key).value_or(0); }

std::uint64_t MapReader::natural(std::string_view key) {
  KeySpec spec = spec_of(key, {Type::integer});
  spec.type = Type::section;  // 64 bits without a sign are no Value
  const Node* node = read(spec).node;
  if (!node) return 0;
  const auto value = to_natural(*node);
  if (value) return *value;
  problems_.add(value.error().origin, in_quotes(key) + " " + value.error().message);
  return 0;
}

bool MapReader::flag(std::string_view key) {
  return get<bool>(spec_of(key, {Type::flag})).value_or(false);
}

std::string MapReader::text(std::string_view key) {
  return get<std::string>(spec_of(key, {Type::text, Type::choice})).value_or("");
}

const Node* MapReader::node(std::string_view key) {
  KeySpec spec = spec_of(key, {Type::section});
  spec.type = Type::section;
  const Reading reading = read(spec);
  return reading.is_written ? reading.node : nullptr;
}

std::optional<double> MapReader::optional_number(std::string_view key) {
  return get<double>(spec_of(key, {Type::number}));
}

std::optional<std::int64_t> MapReader::optional_integer(std::string_view key) {
  return get<std::int64_t>(spec_of(key, {Type::integer}));
}

std::optional<std::vector<double>> MapReader::optional_numbers(std::string_view key) {
  return get<std::vector<double>>(spec_of(key, {Type::numbers}));
}

std::optional<std::vector<std::string>> MapReader::optional_texts(std::string_view key) {
  return get<std::vector<std::string>>(spec_of(key, {Type::texts}));
}

/// A key that is described where it is asked for.
KeySpec MapReader::untabled(std::string_view key, Type type) const {
  if (!table_) return {.name = std::string{key}, .type = type, .optional = true};
  throw std::logic_error{
      fmt::format("what {} may be in {} stands in a table", in_quotes(key), what_)};
}

double MapReader::number(std::string_view key, double fallback) {
  return get<double>(untabled(key, Type::number)).value_or(fallback);
}

std::int64_t MapReader::integer(std::string_view key, std::int64_t fallback) {
  return get<std::int64_t>(untabled(key, Type::integer)).value_or(fallback);
}

bool MapReader::flag(std::string_view key, bool fallback) {
  return get<bool>(untabled(key, Type::flag)).value_or(fallback);
}

std::string MapReader::text(std::string_view key, std::string fallback) {
  return get<std::string>(untabled(key, Type::text)).value_or(std::move(fallback));
}

std::string MapReader::choice(std::string_view key, const std::vector<std::string>& allowed,
                              std::string fallback) {
  KeySpec spec = untabled(key, Type::choice);
  spec.choices = allowed;
  return get<std::string>(spec).value_or(std::move(fallback));
}

const Node* MapReader::optional_node(std::string_view key) {
  return read(untabled(key, Type::section)).node;
}

std::string MapReader::written(std::string_view key) {
  std::string_view name;
  const KeySpec spec = spec_of(key, {Type::section});
  find(spec, &name);
  return std::string{name};
}

void MapReader::problem(std::string_view key, std::string message) {
  const Node* value = find(spec_of(key, {Type::section}));
  problems_.add(value ? value->origin() : node_.origin(), std::move(message));
}

void MapReader::finish() {
  std::set<std::string, std::less<>> known = keys_read_;
  if (table_) known.clear();
  for (const KeySpec& key : table_.value_or(std::span<const KeySpec>{})) {
    known.insert(key.name);
    if (!key.also.empty()) known.insert(key.also);
    if (keys_read_.contains(key.name)) continue;
    throw std::logic_error{
        fmt::format("key {} of {} is in the table and never read", in_quotes(key.name), what_)};
  }
  const std::vector<std::string> names{known.begin(), known.end()};
  for (const Node::Entry& entry : node_.entries()) {
    if (known.contains(entry.key)) continue;
    problems_.add(entry.key_origin, fmt::format("unknown key {} in {}{}", in_quotes(entry.key),
                                                what_, did_you_mean(entry.key, names)));
  }
}

}  // namespace armature::config
