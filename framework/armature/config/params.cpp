// SPDX-License-Identifier: Apache-2.0
#include "armature/config/params.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <filesystem>
#include <stdexcept>
#include <system_error>
#include <utility>

#include "armature/config/conversion.hpp"
#include "armature/config/document.hpp"
#include "armature/config/reader.hpp"
#include "armature/config/unit_suffix.hpp"

namespace armature {
namespace {

using config::Converted;
using config::Mismatch;
using config::Node;
using config::Origin;
using Type = ParamSpec::Type;
using AnyValue = std::variant<double, std::int64_t, bool, std::string, std::vector<double>,
                              std::vector<std::string>>;

/// What is wrong with a number's size; empty: nothing.
std::string out_of_range(const ParamSpec& spec, double value) {
  if (spec.max && value > *spec.max) {
    return fmt::format("is {}, must be at most {}", value, *spec.max);
  }
  if (spec.min && value < *spec.min) {
    return fmt::format("is {}, must be at least {}", value, *spec.min);
  }
  return "";
}

Converted<AnyValue> read_number(const ParamSpec& spec, const Node& node) {
  const auto value = config::to_number(node);
  if (!value) return tl::unexpected{value.error()};
  const std::string fault = out_of_range(spec, *value);
  if (!fault.empty()) return tl::unexpected{Mismatch{node.origin(), fault}};
  return AnyValue{*value * config::si_factor(spec.name)};
}

Converted<AnyValue> read_integer(const ParamSpec& spec, const Node& node) {
  const auto value = config::to_integer(node);
  if (!value) return tl::unexpected{value.error()};
  const std::string fault = out_of_range(spec, static_cast<double>(*value));
  if (!fault.empty()) return tl::unexpected{Mismatch{node.origin(), fault}};
  return AnyValue{*value};
}

Converted<AnyValue> read_numbers(const ParamSpec& spec, const Node& node) {
  auto values = config::to_numbers(node, spec.count);
  if (!values) return tl::unexpected{values.error()};
  for (std::size_t i = 0; i < values->size(); ++i) {
    double& value = (*values)[i];
    const std::string fault = out_of_range(spec, value);
    if (!fault.empty()) {
      return tl::unexpected{
          Mismatch{node.items()[i].origin(), fmt::format("item {} {}", i + 1, fault)}};
    }
    value *= config::si_factor(spec.name);
  }
  return AnyValue{std::move(*values)};
}

Converted<AnyValue> read_choice(const ParamSpec& spec, const Node& node) {
  const auto text = config::to_text(node);
  if (!text) return tl::unexpected{text.error()};
  if (std::ranges::find(spec.choices, *text) != spec.choices.end()) return AnyValue{*text};
  return tl::unexpected{
      Mismatch{node.origin(), fmt::format("cannot be {}{}", config::in_quotes(*text),
                                          config::did_you_mean(*text, spec.choices))}};
}

/// Whether reading `file` might do something, or never end.
bool is_device_or_pipe(const std::filesystem::path& file) {
  std::error_code none;
  const auto status = std::filesystem::status(file, none);
  return std::filesystem::exists(status) && !std::filesystem::is_regular_file(status) &&
         !std::filesystem::is_directory(status);
}

/// `folder` is where a relative path starts.
Converted<AnyValue> read_file(const Node& node, const std::filesystem::path& folder) {
  const auto text = config::to_text(node);
  if (!text) return tl::unexpected{text.error()};
  const bool as_written = text->empty() || folder.empty();
  const std::string file = as_written ? *text : (folder / *text).lexically_normal().string();
  if (!is_device_or_pipe(file)) return AnyValue{file};
  return tl::unexpected{Mismatch{
      node.origin(), fmt::format("names {}, which is a device or a pipe; name a file or a folder",
                                 config::in_quotes(file))}};
}

Converted<AnyValue> read_value(const ParamSpec& spec, const Node& node,
                               const std::filesystem::path& folder) {
  const auto as_any = [](auto value) { return AnyValue{std::move(value)}; };
  switch (spec.type) {
    case Type::number:
      return read_number(spec, node);
    case Type::integer:
      return read_integer(spec, node);
    case Type::flag:
      return config::to_flag(node).map(as_any);
    case Type::text:
      return config::to_text(node).map(as_any);
    case Type::choice:
      return read_choice(spec, node);
    case Type::numbers:
      return read_numbers(spec, node);
    case Type::texts:
      return config::to_texts(node).map(as_any);
    case Type::file:
      return read_file(node, folder);
  }
  return AnyValue{};
}

/// What stands for a value that could not be read, so that asking for it has an answer.
AnyValue zero(Type type) {
  switch (type) {
    case Type::number:
      return 0.0;
    case Type::integer:
      return std::int64_t{0};
    case Type::flag:
      return false;
    case Type::text:
    case Type::choice:
    case Type::file:
      return std::string{};
    case Type::numbers:
      return std::vector<double>{};
    case Type::texts:
      return std::vector<std::string>{};
  }
  return 0.0;
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
    const Node* written = spec.fallback ? map.optional_node(spec.name) : map.node(spec.name);
    const Node* node = written ? written : spec.fallback ? &*spec.fallback : nullptr;
    Value value{spec.type, zero(spec.type), node ? node->origin() : place, written != nullptr};
    if (node) {
      auto read = read_value(spec, *node, written ? config::folder_of(node->origin()) : "");
      if (read) {
        value.value = std::move(*read);
        if (spec.type == Type::choice) {
          const auto& text = std::get<std::string>(value.value);
          value.choice = static_cast<std::size_t>(std::ranges::find(spec.choices, text) -
                                                  spec.choices.begin());
        }
      } else {
        is_sound = false;
        problems.add(read.error().origin,
                     fmt::format("{} {}", config::in_quotes(spec.name), read.error().message));
      }
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
