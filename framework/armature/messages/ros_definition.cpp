// SPDX-License-Identifier: Apache-2.0
#include "armature/messages/ros_definition.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <vector>

namespace armature {
namespace {

std::string_view ros_kind(FieldKind kind) {
  switch (kind) {
    case FieldKind::boolean: return "bool";
    case FieldKind::octet: return "uint8";
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
    case FieldKind::structure: break;
  }
  return "";
}

/// The types in `type`, each once, in the order in which they are met.
void add_nested(const TypeDescription& type, std::vector<const TypeDescription*>& all) {
  for (const FieldDescription& field : type.fields) {
    if (!field.structure || std::ranges::find(all, field.structure) != all.end()) continue;
    all.push_back(field.structure);
    add_nested(*field.structure, all);
  }
}

std::string fields_of(const TypeDescription& type) {
  std::string text;
  for (const FieldDescription& field : type.fields) text += ros_field(field, "") + "\n";
  return text;
}

}  // namespace

std::string ros2_name(const TypeDescription& type) {
  const std::size_t slash = type.ros_name.find('/');
  return type.ros_name.substr(0, slash) + "/msg/" + type.ros_name.substr(slash + 1);
}

std::string ros_field(const FieldDescription& field, const std::string& package) {
  std::string type =
      field.structure ? field.structure->ros_name : std::string{ros_kind(field.kind)};
  if (!package.empty() && type.starts_with(package + "/")) type = type.substr(package.size() + 1);
  const std::string bound = std::to_string(field.bound);
  if (field.shape == FieldDescription::Shape::array) type += "[" + bound + "]";
  if (field.shape == FieldDescription::Shape::sequence) {
    type += field.bound > 0 ? "[<=" + bound + "]" : "[]";
  }
  return type + " " + field.name;
}

std::string ros_definition(const TypeDescription& type) {
  std::vector<const TypeDescription*> nested;
  add_nested(type, nested);
  std::string text = fields_of(type);
  for (const TypeDescription* one : nested) {
    text += fmt::format("{:=<80}\nMSG: {}\n{}", "", one->ros_name, fields_of(*one));
  }
  return text;
}

}  // namespace armature
