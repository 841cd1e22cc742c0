// SPDX-License-Identifier: Apache-2.0
#include "armature/messages/type_description.hpp"

#include <algorithm>
#include <array>

namespace armature {
namespace {

constexpr std::array<KindNames, 13> kKinds{{
    {FieldKind::boolean, "boolean", "bool", "bool", 1},
    {FieldKind::octet, "octet", "uint8", "std::uint8_t", 1},
    {FieldKind::int8, "int8", "int8", "std::int8_t", 1},
    {FieldKind::int16, "int16", "int16", "std::int16_t", 2},
    {FieldKind::uint16, "uint16", "uint16", "std::uint16_t", 2},
    {FieldKind::int32, "int32", "int32", "std::int32_t", 4},
    {FieldKind::uint32, "uint32", "uint32", "std::uint32_t", 4},
    {FieldKind::int64, "int64", "int64", "std::int64_t", 8},
    {FieldKind::uint64, "uint64", "uint64", "std::uint64_t", 8},
    {FieldKind::float32, "float32", "float32", "float", 4},
    {FieldKind::float64, "float64", "float64", "double", 8},
    {FieldKind::text, "string", "string", "std::string", 4},
    {FieldKind::structure, "struct", "", "", 1},
}};
static_assert(std::ranges::is_sorted(kKinds, {}, &KindNames::kind));

std::string flattened(const TypeDescription& type) {
  std::string text;
  for (const FieldDescription& field : type.fields) {
    text += field.name + ":";
    text += field.kind == FieldKind::structure ? "{" + flattened(*field.structure) + "}"
                                               : std::string{names_of(field.kind).idl};
    if (field.shape == FieldDescription::Shape::array) text += "[" + std::to_string(field.bound);
    if (field.shape == FieldDescription::Shape::sequence) text += "<" + std::to_string(field.bound);
    text += ";";
  }
  return text;
}

}  // namespace

const KindNames& names_of(FieldKind kind) { return kKinds.at(static_cast<std::size_t>(kind)); }

std::size_t smallest_size(const FieldDescription& field) {
  return field.structure ? field.structure->smallest_size : names_of(field.kind).smallest_size;
}

const TypeDescription* TypeDescriptions::find(std::string_view name) const {
  for (const auto& type : types_) {
    if (type->dds_name == name || type->ros_name == name) return type.get();
  }
  return nullptr;
}

std::uint64_t layout_hash(const TypeDescription& type) {
  std::uint64_t hash = 0xcbf29ce484222325;  // FNV-1a, 64 bit
  for (const char c : type.dds_name + "{" + flattened(type) + "}") {
    hash ^= static_cast<unsigned char>(c);
    hash *= 0x100000001b3;
  }
  return hash;
}

}  // namespace armature
