// SPDX-License-Identifier: Apache-2.0
#include "replay/message_difference.hpp"

#include <fmt/format.h>

#include <bit>
#include <nlohmann/json.hpp>

#include "armature/messages/cdr_to_json.hpp"
#include "armature/values/json_text.hpp"

namespace armature {
namespace {

using Json = nlohmann::ordered_json;
using Shape = FieldDescription::Shape;

/// Floating-point numbers in their order, -0 and 0 side by side.
template <class Number, class Bits>
Bits rank(Number number) {
  constexpr Bits kSign = Bits{1} << (8 * sizeof(Bits) - 1);
  const Bits bits = std::bit_cast<Bits>(number);
  return (bits & kSign) != 0 ? ~bits : bits | kSign;
}

template <class Number, class Bits>
std::optional<MessageDifference> number_difference(const Json& a, const Json& b) {
  const Bits first = rank<Number, Bits>(a.get<Number>());
  const Bits second = rank<Number, Bits>(b.get<Number>());
  if (first == second) return std::nullopt;
  return MessageDifference{.field = {},
                           .recorded = fmt::format("{}", a.get<Number>()),
                           .replayed = fmt::format("{}", b.get<Number>()),
                           .ulps = first > second ? first - second : second - first};
}

std::optional<MessageDifference> structure_difference(const TypeDescription& type, const Json& a,
                                                      const Json& b);

std::optional<MessageDifference> element_difference(const FieldDescription& field, const Json& a,
                                                    const Json& b) {
  if (field.kind == FieldKind::structure) return structure_difference(*field.structure, a, b);
  if (field.kind == FieldKind::float64) return number_difference<double, std::uint64_t>(a, b);
  if (field.kind == FieldKind::float32) return number_difference<float, std::uint32_t>(a, b);
  if (a == b) return std::nullopt;
  return MessageDifference{.field = {}, .recorded = json_text(a), .replayed = json_text(b)};
}

std::optional<MessageDifference> array_difference(const FieldDescription& field, const Json& a,
                                                  const Json& b) {
  for (std::size_t i = 0; i < std::min(a.size(), b.size()); ++i) {
    if (auto found = element_difference(field, a[i], b[i])) {
      found->field = fmt::format("[{}]{}{}", i, found->field.empty() ? "" : ".", found->field);
      return found;
    }
  }
  if (a.size() == b.size()) return std::nullopt;
  return MessageDifference{.field = {},
                           .recorded = fmt::format("{} elements", a.size()),
                           .replayed = fmt::format("{}", b.size())};
}

std::optional<MessageDifference> structure_difference(const TypeDescription& type, const Json& a,
                                                      const Json& b) {
  for (const FieldDescription& field : type.fields) {
    const bool is_single = field.shape == Shape::single;
    auto found = is_single ? element_difference(field, a[field.name], b[field.name])
                           : array_difference(field, a[field.name], b[field.name]);
    if (!found) continue;
    const bool is_nested = !found->field.empty() && found->field.front() != '[';
    found->field = field.name + (is_nested ? "." : "") + found->field;
    return found;
  }
  return std::nullopt;
}

}  // namespace

std::optional<MessageDifference> first_difference(const TypeDescription& type,
                                                  std::span<const std::byte> recorded,
                                                  std::span<const std::byte> replayed) {
  const auto a = cdr_to_json(type, recorded, OctetArrays::whole);
  const auto b = cdr_to_json(type, replayed, OctetArrays::whole);
  if (!a || !b) {
    const auto told = [](const auto& message) {
      return message ? std::string{"a message"} : message.error().text;
    };
    return MessageDifference{.field = "all", .recorded = told(a), .replayed = told(b)};
  }
  return structure_difference(type, *a, *b);
}

}  // namespace armature
