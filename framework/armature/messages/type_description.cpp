// SPDX-License-Identifier: Apache-2.0
#include "armature/messages/type_description.hpp"

namespace armature {
namespace {

std::string_view kind_name(FieldKind kind) {
  switch (kind) {
    case FieldKind::boolean: return "boolean";
    case FieldKind::octet: return "octet";
    case FieldKind::int8: return "int8";
    case FieldKind::int16: return "int16";
    case FieldKind::uint16: return "uint16";
    case FieldKind::int32: return "int32";
    case FieldKind::uint32: return "uint32";
    case FieldKind::int64: return "int64";
    case FieldKind::uint64: return "uint64";
    case FieldKind::float32: return "float32";
    case FieldKind::float64: return "float64";
    case FieldKind::text: return "string";
    case FieldKind::structure: return "struct";
  }
  return "";
}

std::string flattened(const TypeDescription& type) {
  std::string text;
  for (const FieldDescription& field : type.fields) {
    text += field.name + ":";
    text += field.kind == FieldKind::structure ? "{" + flattened(*field.structure) + "}"
                                               : std::string{kind_name(field.kind)};
    if (field.shape == FieldDescription::Shape::array) text += "[" + std::to_string(field.bound);
    if (field.shape == FieldDescription::Shape::sequence) text += "<" + std::to_string(field.bound);
    text += ";";
  }
  return text;
}

}  // namespace

std::size_t smallest_size(const FieldDescription& field) {
  switch (field.kind) {
    case FieldKind::boolean:
    case FieldKind::octet:
    case FieldKind::int8: return 1;
    case FieldKind::int16:
    case FieldKind::uint16: return 2;
    case FieldKind::int32:
    case FieldKind::uint32:
    case FieldKind::float32:
    case FieldKind::text: return 4;
    case FieldKind::int64:
    case FieldKind::uint64:
    case FieldKind::float64: return 8;
    case FieldKind::structure: return field.structure->smallest_size;
  }
  return 1;
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
