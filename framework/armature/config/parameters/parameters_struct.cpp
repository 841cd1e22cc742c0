// SPDX-License-Identifier: Apache-2.0
#include "armature/config/parameters/parameters_struct.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <limits>
#include <utility>
#include <vector>

#include "armature/config/parameters/cpp_name.hpp"
#include "armature/config/params.hpp"
#include "armature/config/reader.hpp"
#include "armature/config/unit_suffix.hpp"

namespace armature {
namespace {

using Type = ParamSpec::Type;

/// `name` without its unit, unless another parameter would have the same name then.
std::string member_name(const ParamSpec& spec, const std::vector<ParamSpec>& all) {
  const std::string_view stem = config::without_unit(spec.name);
  const bool is_ambiguous = std::ranges::any_of(all, [&](const ParamSpec& other) {
    return other.name != spec.name && config::without_unit(other.name) == stem;
  });
  const config::UnitSuffix* unit = config::unit_of(spec.name);
  return is_ambiguous && unit ? fmt::format("{}_{}", stem, unit->si) : in_cpp(stem);
}

bool fits_int(const ParamSpec& spec) {
  using Int = std::numeric_limits<int>;
  return spec.min && spec.max && *spec.min >= Int::min() && *spec.max <= Int::max();
}

std::string type_of(const ParamSpec& spec, const std::string& member) {
  switch (spec.type) {
    case Type::number: return "double";
    case Type::integer:
      return fits_int(spec) ? "int" : spec.min && *spec.min >= 0 ? "std::uint64_t" : "std::int64_t";
    case Type::flag: return "bool";
    case Type::choice: return camel_case(member);
    case Type::text:
    case Type::file: return "std::string";
    case Type::numbers:
      return spec.count ? fmt::format("std::array<double, {}>", *spec.count)
                        : "std::vector<double>";
    case Type::texts: return "std::vector<std::string>";
    case Type::section: break;  // of files, not of parameters
  }
  return "";
}

/// The expression that reads it from `Params params`.
std::string read_of(const ParamSpec& spec, const std::string& type) {
  switch (spec.type) {
    case Type::number:
    case Type::flag:
    case Type::text:
    case Type::file:
    case Type::texts: return fmt::format("params.{}(\"{}\")", to_string(spec.type), spec.name);
    case Type::integer:
    case Type::choice:
      return fmt::format("static_cast<{}>(params.{}(\"{}\"))", type, to_string(spec.type),
                         spec.name);
    case Type::numbers:
      return spec.count ? fmt::format("params.numbers<{}>(\"{}\")", *spec.count, spec.name)
                        : fmt::format("params.numbers(\"{}\")", spec.name);
    case Type::section: break;
  }
  return "";
}

std::string double_text(double value) {
  const std::string text = fmt::format("{}", value);
  return text.find_first_of(".en") == std::string::npos ? text + ".0" : text;
}

/// The default as C++; "" when it must be written.
std::string default_of(const ParamSpec& spec, const Params& defaults) {
  if (!spec.fallback) return "";
  switch (spec.type) {
    case Type::number: return double_text(defaults.number(spec.name));
    case Type::integer: return fmt::format("{}", defaults.integer(spec.name));
    case Type::flag: return defaults.flag(spec.name) ? "true" : "false";
    case Type::choice: return in_cpp(defaults.text(spec.name));
    case Type::text: return literal_of(defaults.text(spec.name));
    case Type::file: return literal_of(defaults.file(spec.name));
    case Type::numbers: {
      std::vector<std::string> numbers;
      for (const double number : defaults.numbers(spec.name)) {
        numbers.push_back(double_text(number));
      }
      return fmt::format("{}", fmt::join(numbers, ", "));
    }
    case Type::texts: {
      std::vector<std::string> texts;
      for (const std::string& text : defaults.texts(spec.name)) texts.push_back(literal_of(text));
      return fmt::format("{}", fmt::join(texts, ", "));
    }
    case Type::section: break;
  }
  return "";
}

/// "[rad] The tilt of the head".
std::string doc_of(const ParamSpec& spec) {
  const config::UnitSuffix* unit = config::unit_of(spec.name);
  if (!unit) return spec.doc;
  return fmt::format("[{}]{}{}", unit->si, spec.doc.empty() ? "" : " ", spec.doc);
}

void check_choices(const ParamSpec& spec, const config::Origin& place, config::Problems& problems) {
  for (const std::string& choice : spec.choices) {
    const bool is_name = std::ranges::all_of(choice, is_in_a_name) && !choice.empty() &&
                         !(choice.front() >= '0' && choice.front() <= '9');
    if (is_name) continue;
    problems.add(place, fmt::format("parameter {}: the choice {} must be a name, of letters, "
                                    "digits and '_'",
                                    config::in_quotes(spec.name), config::in_quotes(choice)));
  }
}

}  // namespace

std::vector<std::string> parameter_members(const std::vector<ParamSpec>& specs) {
  std::vector<std::string> members;
  for (const ParamSpec& spec : specs) members.push_back(member_name(spec, specs));
  return members;
}

void check_plugin(const config::Node& manifest, const std::string& id, config::Problems& problems) {
  config::MapReader map{manifest, "plugin.yaml", problems};
  map.read(config::format_key("armature_plugin"));
  const std::string own = map.text("id", id);
  if (own == id) return;
  map.problem("id",
              fmt::format("the id is {}, and CMakeLists.txt says armature_add_plugin({} ...): "
                          "write the same in both",
                          config::in_quotes(own), id));
}

std::string parameters_header(const config::Node& manifest, config::Problems& problems) {
  const config::Node* id_node = manifest.find("id");
  const std::string id = id_node ? config::as_text(*id_node, problems).value_or("") : "";
  const config::Node* table = manifest.find("params");
  std::vector<ParamSpec> specs;
  if (table) specs = read_param_specs(*table, problems);
  for (const ParamSpec& spec : specs) check_choices(spec, table->origin(), problems);
  if (!problems.empty()) return "";

  std::vector<ParamSpec> with_default;
  for (ParamSpec spec : specs) {
    spec.below = spec.at_most = "";  // which may have none
    if (spec.fallback) with_default.push_back(std::move(spec));
  }
  const Params defaults = Params::read(with_default, nullptr, id, problems);

  std::string enums, members, reads;
  for (const ParamSpec& spec : specs) {
    const std::string member = member_name(spec, specs), type = type_of(spec, member);
    if (spec.type == Type::choice) {
      std::vector<std::string> names;
      for (const std::string& choice : spec.choices) names.push_back(in_cpp(choice));
      enums += fmt::format("  enum class {} {{ {} }};\n", type, fmt::join(names, ", "));
    }
    const std::string value = default_of(spec, defaults);
    const std::string initial = spec.type == Type::choice && spec.fallback
                                    ? fmt::format(" = {}::{}", type, value)
                                    : fmt::format("{{{}}}", value);
    members += fmt::format("{}  {} {}{};\n", comment_of(doc_of(spec)), type, member, initial);
    reads += fmt::format("{}.{} = {}", reads.empty() ? "" : ",\n            ", member,
                         read_of(spec, type));
  }
  return fmt::format(R"(// Made from the plugin.yaml of {0}: change it there.
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "armature/config/params.hpp"

namespace {1} {{

/// The parameters of {0}, in SI units and radians, with their defaults.
struct Parameters {{
{2}{3}
  static Parameters read(const Params&{4}) {{
    return {{{5}}};
  }}
}};

}}  // namespace {1}
)",
                     id, namespace_of(id), enums, members, specs.empty() ? "" : " params", reads);
}

}  // namespace armature
