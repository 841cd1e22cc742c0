// SPDX-License-Identifier: Apache-2.0
#include "armature/messages/ros_definition.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <vector>

namespace armature {
namespace {

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
      field.structure ? field.structure->ros_name : std::string{names_of(field.kind).ros};
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
