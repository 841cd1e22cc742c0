// SPDX-License-Identifier: Apache-2.0
#include "armature/config/params.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <stdexcept>
#include <utility>

#include "armature/config/reader.hpp"
#include "armature/config/unit_suffix.hpp"

namespace armature {

using config::Node;
using config::Origin;
using Type = ParamSpec::Type;

namespace {

/// An empty text for a parameter that nothing else stands for.
bool is_missing_text(const ParamSpec& spec, const config::Value& value) {
  const auto* text = std::get_if<std::string>(&value);
  return text && text->empty() && !spec.fallback && !spec.optional;
}

}  // namespace

Params Params::read(const std::vector<ParamSpec>& specs, const Node* given,
                    std::string_view plugin_id, config::Problems& problems, const Origin& place) {
  const bool is_given = given && (given->kind() != Node::Kind::null || !given->text().empty());
  const Node nothing = Node::map({}, given ? given->origin() : place);
  config::MapReader map{is_given ? *given : nothing, fmt::format("params of '{}'", plugin_id),
                        problems};
  Params params;
  params.plugin_id_ = plugin_id;
  params.place_ = nothing.origin();
  bool is_sound = true;
  for (const ParamSpec& spec : specs) {
    const config::MapReader::Reading read = map.read(spec);
    Value value{spec.type, read.value.value_or(config::zero_of(spec.type)),
                read.node ? read.node->origin() : place, read.is_written};
    if (!read.value && (read.node || !spec.optional)) is_sound = false;
    if (read.value && read.node && is_missing_text(spec, *read.value)) {
      problems.add(read.node->origin(),
                   fmt::format("'{}' is empty, and has no default", spec.name));
    }
    if (read.value && spec.type == Type::choice) {
      const auto& text = std::get<std::string>(value.value);
      value.choice =
          static_cast<std::size_t>(std::ranges::find(spec.choices, text) - spec.choices.begin());
    }
    params.values_.emplace(spec.name, std::move(value));
  }
  map.finish();
  for (const ParamSpec& spec : specs) {
    if (is_sound) params.check_order(spec, problems);
  }
  return params;
}

void Params::check_order(const ParamSpec& spec, config::Problems& problems) const {
  const bool is_own = spec.at_most.find('.') == std::string::npos;
  const std::string& limit = !spec.below.empty() ? spec.below : is_own ? spec.at_most : "";
  if (limit.empty()) return;
  const auto amount = [&](const std::string& name) {
    const Value& found = find(name);
    if (found.type == Type::integer)
      return static_cast<double>(std::get<std::int64_t>(found.value));
    return std::get<double>(found.value) / config::si_factor(name);
  };
  const double value = amount(spec.name), most = amount(limit);
  if (spec.below.empty() ? value <= most : value < most) return;
  const Origin& place = find(spec.name).written ? find(spec.name).origin
                        : find(limit).written   ? find(limit).origin
                                                : place_;
  problems.add(place, fmt::format("'{}' is {:g}, {} '{}', which is {:g}{}{}", spec.name, value,
                                  spec.below.empty() ? "above" : "not below", limit, most,
                                  spec.otherwise.empty() ? "" : ": ", spec.otherwise));
}

const Params::Value& Params::find(std::string_view name) const {
  const auto found = values_.find(name);
  if (found != values_.end()) return found->second;
  std::vector<std::string> known;
  for (const auto& [key, value] : values_) known.push_back(key);
  throw std::logic_error{
      fmt::format("'{}' asks for the parameter '{}', which its plugin.yaml does "
                  "not declare{}",
                  plugin_id_, name, config::did_you_mean(name, known))};
}

const Params::Value& Params::get(std::string_view name,
                                 std::initializer_list<ParamSpec::Type> types) const {
  const Value& value = find(name);
  if (std::ranges::find(types, value.type) != types.end()) return value;
  throw std::logic_error{
      fmt::format("'{}' asks for the parameter '{}' as {}, but its plugin.yaml "
                  "declares type {}",
                  plugin_id_, name, to_string(*types.begin()), to_string(value.type))};
}

double Params::number(std::string_view name) const {
  return std::get<double>(get(name, {Type::number}).value);
}

std::vector<double> Params::numbers(std::string_view name) const {
  return std::get<std::vector<double>>(get(name, {Type::numbers}).value);
}

std::int64_t Params::integer(std::string_view name) const {
  return std::get<std::int64_t>(get(name, {Type::integer}).value);
}

bool Params::flag(std::string_view name) const {
  return std::get<bool>(get(name, {Type::flag}).value);
}

const std::string& Params::text(std::string_view name) const {
  return std::get<std::string>(get(name, {Type::text, Type::choice}).value);
}

std::size_t Params::choice(std::string_view name) const { return get(name, {Type::choice}).choice; }

const std::vector<std::string>& Params::texts(std::string_view name) const {
  return std::get<std::vector<std::string>>(get(name, {Type::texts}).value);
}

std::string Params::file(std::string_view name) const {
  return std::get<std::string>(get(name, {Type::file}).value);
}

bool Params::agree(std::string_view name, const Params& others) {
  Value& own = values_.find(name)->second;
  const Value& there = others.get(name, {own.type});
  if (own.written) return own.value == there.value;
  own = there;
  own.written = true;
  return true;
}

const Origin& Params::origin(std::string_view name) const { return find(name).origin; }

void Params::refuse(std::initializer_list<std::string_view> names,
                    const std::string& message) const {
  const auto written =
      std::ranges::find_if(names, [&](const std::string_view name) { return find(name).written; });
  const Origin& place = written == names.end() ? place_ : find(*written).origin;
  throw config::ConfigError{{{place, message}}};
}

}  // namespace armature
