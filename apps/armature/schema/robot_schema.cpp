// SPDX-License-Identifier: Apache-2.0
#include "schema/robot_schema.hpp"

#include <nlohmann/json.hpp>
#include <utility>

#include "armature/robot/files/robot_keys.hpp"
#include "armature/robot/files/stereo_rig.hpp"
#include "schema/value_schema.hpp"

namespace armature {
namespace {

using Json = nlohmann::ordered_json;

Json joint_schema(Joint::Type type) {
  Json properties = properties_of(joint_keys(type, false));
  Json& coupled = properties["coupled"];
  coupled =
      map_schema(coupled["description"].get<std::string>(), properties_of(coupling_keys(type)));
  return map_schema("", std::move(properties));
}

/// A row by what it says of its type; of one that says nothing the joint turns.
Json row_schema() {
  Json schema;
  schema["if"]["required"] = Json::array({"type"});
  schema["if"]["properties"]["type"]["const"] = "prismatic";
  schema["then"] = joint_schema(Joint::Type::prismatic);
  schema["else"] = joint_schema(Joint::Type::revolute);
  return schema;
}

/// An entry beside `urdf:`, where only the URDF file knows what the joint does.
Json urdf_joint_schema() {
  Json properties = properties_of(urdf_joint_keys(Joint::Type::revolute));
  properties.update(properties_of(urdf_joint_keys(Joint::Type::prismatic)));
  return map_schema("", std::move(properties));
}

Json joints_of(Json joint) {
  Json rule;
  rule["properties"]["joints"]["items"] = std::move(joint);
  return rule;
}

/// What only one of both sorts of file has. A file that includes another one may be either.
Json sort_rule() {
  const auto without = [](Json rule, const char* key) {
    rule["properties"][key] = false;
    return rule;
  };
  Json from_rows{{"if", {{"required", {"include"}}}}};
  from_rows["then"] = joints_of({{"anyOf", Json::array({row_schema(), urdf_joint_schema()})}});
  from_rows["else"] = without(without(joints_of(row_schema()), "base"), "tip");
  Json rule{{"if", {{"required", {"urdf"}}}}};
  rule["then"] = without(joints_of(urdf_joint_schema()), "convention");
  rule["else"] = std::move(from_rows);
  return rule;
}

/// A word, or a list of 3 numbers.
void allow_axis(Json& schema) {
  const config::KeySpec direction{
      .name = "axis", .type = config::KeySpec::Type::numbers, .count = 3};
  schema["anyOf"] = Json::array({word_schema(axis_words(), ""), schema_of(direction)});
}

Json file_schema(const char* title, const char* doc, Json properties) {
  properties["include"] = paths_schema("Files that this one stands on, relative to it.");
  Json schema{{"$schema", "https://json-schema.org/draft/2020-12/schema"}, {"title", title}};
  schema.update(map_schema(doc, std::move(properties)));
  return schema;
}

}  // namespace

Json robot_schema() {
  Json properties = properties_of(urdf_robot_keys());
  properties.update(properties_of(robot_keys()));
  properties["joints"]["type"] = {"array", "null"};
  properties["frames"] = names_schema(properties["frames"]["description"].get<std::string>(),
                                      map_schema("", properties_of(frame_keys())));
  allow_axis(properties["pointing_axis"]);
  Json shaft = properties_of(shaft_keys());
  allow_axis(shaft["axis"]);
  properties["shaft"] =
      map_schema(properties["shaft"]["description"].get<std::string>(), std::move(shaft));
  properties["capsules"] = names_schema(properties["capsules"]["description"].get<std::string>(),
                                        map_schema("", properties_of(capsule_keys())));
  properties["masses"] = names_schema(properties["masses"]["description"].get<std::string>(),
                                      map_schema("", properties_of(mass_keys())));
  Json schema = file_schema("Armature robot", "A robot file of Armature.", std::move(properties));
  schema["allOf"] = Json::array({sort_rule()});
  return schema;
}

Json rig_schema() {
  Json properties = properties_of(rig_keys());
  properties["mount"] = map_schema(properties["mount"]["description"].get<std::string>(),
                                   properties_of(mount_keys()));
  return file_schema("Armature rig", "A stereo rig of Armature.", std::move(properties));
}

}  // namespace armature
