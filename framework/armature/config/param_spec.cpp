// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <utility>

#include "armature/config/key_rows.hpp"
#include "armature/config/params.hpp"
#include "armature/config/reader.hpp"
#include "armature/config/unit_suffix.hpp"

namespace armature {
namespace {

using config::MapReader;
using config::Node;
using config::Problems;
using Type = ParamSpec::Type;

constexpr std::array<std::string_view, 8> kTypeNames{"number", "integer", "flag",  "text",
                                                     "choice", "numbers", "texts", "file"};

bool is_name(std::string_view name) {
  const auto is_lower = [](char c) { return c >= 'a' && c <= 'z'; };
  return !name.empty() && is_lower(name.front()) && std::ranges::all_of(name, [&](char c) {
    return is_lower(c) || (c >= '0' && c <= '9') || c == '_';
  });
}

/// What a plugin.yaml says of a parameter.
const std::vector<config::KeySpec>& keys_of_a_parameter() {
  using namespace config::rows;
  static const std::vector<config::KeySpec> kKeys{
      choice("type", "What it is.").choices({kTypeNames.begin(), kTypeNames.end()}),
      text("doc", "What it does.").fallback(""),
      section("default", "Without: required.").optional(),
      number("min", "Of every number, inclusive.").optional(),
      number("max", "Of every number, inclusive.").optional(),
      texts("choices", "Of a choice.").optional(),
      integer("count", "Of numbers.").min(1).optional(),
      text("same_as", "The plugin whose parameter of this name says the same.").fallback(""),
      text("at_most", "The parameter that it is not above.").fallback(""),
      text("below", "The parameter that it is below.").fallback(""),
      text("else", "What would be wrong if it were not.").fallback("")};
  return kKeys;
}

void read_choices(ParamSpec& spec, MapReader& map) {
  const Node* choices = map.node("choices");
  if (!choices && spec.type == Type::choice) {
    map.problem("choices", "a choice needs 'choices: [...]'");
  }
  if (!choices) return;
  if (spec.type != Type::choice) map.problem("choices", "'choices' belong to a choice");
  spec.choices = map.optional_texts("choices").value_or(std::vector<std::string>{});
  if (choices->kind() == Node::Kind::sequence && choices->items().empty()) {
    map.problem("choices", "'choices' must be a list of texts, not empty");
  }
}

void read_range(ParamSpec& spec, MapReader& map) {
  const bool is_numeric =
      spec.type == Type::number || spec.type == Type::integer || spec.type == Type::numbers;
  for (const auto& [key, bound] : {std::pair{"min", &spec.min}, std::pair{"max", &spec.max}}) {
    *bound = map.optional_number(key);
    if (*bound && !is_numeric) map.problem(key, fmt::format("'{}' belongs to a number", key));
  }
  if (spec.min && spec.max && *spec.min > *spec.max) {
    map.problem("max", fmt::format("'max' is {}, below 'min', which is {}", *spec.max, *spec.min));
  }
}

void read_count(ParamSpec& spec, MapReader& map) {
  const auto count = map.optional_integer("count");
  if (!count) return;
  if (spec.type != Type::numbers) map.problem("count", "'count' belongs to numbers");
  spec.count = static_cast<std::size_t>(*count);
}

/// A fallback is checked as if a user had given it.
void check_fallback(const ParamSpec& spec, Problems& problems) {
  if (!spec.fallback) return;
  const config::Origin& origin = spec.fallback->origin();
  const Node given = Node::map({{spec.name, origin, *spec.fallback}}, origin);
  ParamSpec required = spec;
  required.fallback.reset();
  required.optional = true;                // an empty text stands for none
  required.below = required.at_most = "";  // which takes another one
  Params::read({required}, &given, "", problems);
}

ParamSpec read_param_spec(const Node::Entry& entry, Problems& problems) {
  ParamSpec spec;
  spec.name = entry.key;
  if (!is_name(spec.name)) {
    problems.add(entry.key_origin, fmt::format("parameter {} must be named in snake_case",
                                               config::in_quotes(spec.name)));
  }
  if (const std::string wrong = config::unknown_unit(spec.name); !wrong.empty()) {
    problems.add(entry.key_origin,
                 fmt::format("parameter {}: {}", config::in_quotes(spec.name), wrong));
  }
  MapReader map{entry.value, "parameter " + config::in_quotes(spec.name), keys_of_a_parameter(),
                problems};
  const std::string type = map.text("type");
  const auto found = std::ranges::find(kTypeNames, type);
  const bool has_type = found != kTypeNames.end();
  if (has_type) spec.type = static_cast<Type>(found - kTypeNames.begin());
  spec.doc = map.text("doc");
  spec.same_as = map.text("same_as");
  spec.at_most = map.text("at_most");
  spec.below = map.text("below");
  spec.otherwise = map.text("else");
  if (const Node* fallback = map.node("default")) spec.fallback = *fallback;
  if (!spec.same_as.empty() && !spec.fallback) {
    map.problem("same_as", fmt::format("'same_as' needs a default, for deployments without '{}'",
                                       spec.same_as));
  }
  const std::size_t dot = spec.same_as.find('.');
  if (dot != std::string::npos && spec.same_as.substr(dot + 1) != spec.name) {
    map.problem("same_as", fmt::format("behind the output 'same_as' must name '{}', too: both "
                                       "parameters are called the same",
                                       spec.name));
  }
  const bool is_one = spec.type == Type::number || spec.type == Type::integer;
  for (const auto& [key, limit] : {std::pair{"at_most", &spec.at_most}, {"below", &spec.below}}) {
    if (!limit->empty() && !is_one) map.problem(key, fmt::format("'{}' belongs to a number", key));
  }
  read_choices(spec, map);
  read_range(spec, map);
  read_count(spec, map);
  map.finish();
  if (has_type) check_fallback(spec, problems);
  return spec;
}

/// Parameters that are compared must be of one type and one unit, and their defaults in order.
void check_orders(const std::vector<ParamSpec>& specs, const Node& table, Problems& problems) {
  bool is_sound = problems.empty(), is_compared = false;
  for (const ParamSpec& spec : specs) {
    for (const std::string& limit : {spec.at_most, spec.below}) {
      if (limit.empty() || limit.find('.') != std::string::npos) continue;
      is_compared = true;
      const auto other = std::ranges::find(specs, limit, &ParamSpec::name);
      if (other != specs.end() && other->type == spec.type &&
          config::si_factor(limit) == config::si_factor(spec.name)) {
        continue;
      }
      is_sound = false;
      problems.add(table.origin(),
                   fmt::format("parameter {} is compared with {}, which must be another parameter "
                               "of the same type and unit",
                               config::in_quotes(spec.name), config::in_quotes(limit)));
    }
  }
  const bool all_have_one =
      std::ranges::all_of(specs, [](const ParamSpec& spec) { return spec.fallback.has_value(); });
  if (is_sound && is_compared && all_have_one)
    Params::read(specs, nullptr, "", problems, table.origin());
}

}  // namespace

std::string_view to_string(ParamSpec::Type type) {
  return kTypeNames[static_cast<std::size_t>(type)];
}

std::vector<ParamSpec> read_param_specs(const Node& table, Problems& problems) {
  std::vector<ParamSpec> specs;
  if (table.kind() == Node::Kind::null) return specs;
  if (table.kind() != Node::Kind::map) {
    problems.add(table.origin(), "'params' must be a map, not " + table.describe());
  }
  for (const Node::Entry& entry : table.entries()) {
    specs.push_back(read_param_spec(entry, problems));
  }
  check_orders(specs, table, problems);
  return specs;
}

}  // namespace armature
