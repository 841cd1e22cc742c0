// SPDX-License-Identifier: Apache-2.0
#include "armature/config/key.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <system_error>
#include <utility>

#include "armature/config/problems.hpp"
#include "armature/config/unit_suffix.hpp"
#include "armature/values/angles.hpp"

namespace armature::config {
namespace {

using Type = KeySpec::Type;

tl::unexpected<Mismatch> refused(const Node& node, std::string message) {
  return tl::unexpected<Mismatch>{Mismatch{node.origin(), std::move(message)}};
}

/// "must be from 1 to 5", with all limits times `scale`.
std::string range_of(const KeySpec& key, double scale) {
  if (key.min && key.max) {
    return *key.min == *key.max
               ? fmt::format("must be {}", *key.min * scale)
               : fmt::format("must be from {} to {}", *key.min * scale, *key.max * scale);
  }
  std::vector<std::string> bounds;
  if (key.min) bounds.push_back(fmt::format("at least {}", *key.min * scale));
  if (key.above) bounds.push_back(fmt::format("more than {}", *key.above * scale));
  if (key.max) bounds.push_back(fmt::format("at most {}", *key.max * scale));
  return fmt::format("must be {}", fmt::join(bounds, " and "));
}

/// What is wrong with the size of a number that stands under `written`; empty: nothing.
std::string out_of_range(const KeySpec& key, std::string_view written, double value) {
  // Limits are stated in the unit of the key's name.
  const double scale = si_factor(key.name) / si_factor(written);
  const bool is_within = !(key.min && value < *key.min * scale) &&
                         !(key.max && value > *key.max * scale) &&
                         !(key.above && value <= *key.above * scale);
  if (is_within) return "";
  return fmt::format("is {}, {}{}{}", value, range_of(key, scale), key.because.empty() ? "" : ": ",
                     key.because);
}

/// Why a length or an angle is refused that its key does not limit; empty: it is not. A robot has
/// none so large: it is told in another unit.
std::string far_from_any_robot(const KeySpec& key, std::string_view written, double value) {
  constexpr double kMaxLength_m = 100, kMaxAngle_deg = 1e6;
  const UnitSuffix* unit = unit_of(written);
  if (!unit || key.max) return "";
  if (unit->si == "m" && std::abs(value) * unit->to_si > kMaxLength_m) {
    return fmt::format("is {}, farther than {:g} m; is it told in another unit?", value,
                       kMaxLength_m);
  }
  if (unit->si == "rad" && std::abs(value) * unit->to_si > kMaxAngle_deg * kRadPerDegree) {
    return fmt::format("is {}, more than {:g} degrees; is it told in another unit?", value,
                       kMaxAngle_deg);
  }
  return "";
}

/// What is wrong with a number that stands under `written`; empty: nothing.
std::string fault_of(const KeySpec& key, std::string_view written, double value) {
  const std::string fault = out_of_range(key, written, value);
  return fault.empty() ? far_from_any_robot(key, written, value) : fault;
}

Converted<Value> number_of(const KeySpec& key, std::string_view written, const Node& node) {
  const auto value = to_number(node);
  if (!value) return tl::unexpected{value.error()};
  const std::string fault = fault_of(key, written, *value);
  if (!fault.empty()) return refused(node, fault);
  return Value{*value * si_factor(written)};
}

Converted<Value> integer_of(const KeySpec& key, const Node& node) {
  const auto value = to_integer(node);
  if (!value) return tl::unexpected{value.error()};
  const std::string fault = out_of_range(key, key.name, static_cast<double>(*value));
  if (!fault.empty()) return refused(node, fault);
  return Value{*value};
}

Converted<Value> numbers_of(const KeySpec& key, std::string_view written, const Node& node) {
  auto values = to_numbers(node, key.count);
  if (!values) return tl::unexpected{values.error()};
  for (std::size_t i = 0; i < values->size(); ++i) {
    double& value = (*values)[i];
    const std::string fault = fault_of(key, written, value);
    if (!fault.empty()) {
      return refused(node.items()[i], fmt::format("item {} {}", i + 1, fault));
    }
    value *= si_factor(written);
  }
  return Value{std::move(*values)};
}

Converted<Value> choice_of(const KeySpec& key, const Node& node) {
  const auto text = to_text(node);
  if (!text) return tl::unexpected{text.error()};
  if (std::ranges::find(key.choices, *text) != key.choices.end()) return Value{*text};
  return refused(node,
                 fmt::format("cannot be {}{}", in_quotes(*text), did_you_mean(*text, key.choices)));
}

/// Whether reading `file` might do something, or never end.
bool is_device_or_pipe(const std::filesystem::path& file) {
  std::error_code none;
  const auto status = std::filesystem::status(file, none);
  return std::filesystem::exists(status) && !std::filesystem::is_regular_file(status) &&
         !std::filesystem::is_directory(status);
}

Converted<Value> file_of(const Node& node, const std::filesystem::path& folder) {
  const auto text = to_text(node);
  if (!text) return tl::unexpected{text.error()};
  const bool as_written = text->empty() || folder.empty();
  const std::string file = as_written ? *text : (folder / *text).lexically_normal().string();
  if (!is_device_or_pipe(file)) return Value{file};
  return refused(node, fmt::format("names {}, which is a device or a pipe; name a file or a folder",
                                   in_quotes(file)));
}

}  // namespace

Node default_value(std::string text) { return Node::scalar(std::move(text), false, {"default"}); }

KeySpec format_key(std::string name) {
  return {.name = std::move(name),
          .type = Type::integer,
          .doc = "The version of the file format.",
          .min = 1,
          .max = 1,
          .because = "the format that this version reads"};
}

Converted<Value> to_value(const KeySpec& key, std::string_view written, const Node& node,
                          const std::string& folder) {
  const auto as_any = [](auto value) { return Value{std::move(value)}; };
  switch (key.type) {
    case Type::number: return number_of(key, written, node);
    case Type::integer: return integer_of(key, node);
    case Type::flag: return to_flag(node).map(as_any);
    case Type::text: return to_text(node).map(as_any);
    case Type::choice: return choice_of(key, node);
    case Type::numbers: return numbers_of(key, written, node);
    case Type::texts: return to_texts(node).map(as_any);
    case Type::file: return file_of(node, folder);
    case Type::section: break;
  }
  return Value{};
}

Value zero_of(Type type) {
  switch (type) {
    case Type::integer: return std::int64_t{0};
    case Type::flag: return false;
    case Type::text:
    case Type::choice:
    case Type::file: return std::string{};
    case Type::numbers: return std::vector<double>{};
    case Type::texts: return std::vector<std::string>{};
    case Type::number:
    case Type::section: break;
  }
  return 0.0;
}

}  // namespace armature::config
