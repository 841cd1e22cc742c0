// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "armature/messages/type_description.hpp"

namespace armature ARMATURE_EXPORT {

/// "sensor_msgs/msg/JointState", as ROS 2 tools call a type.
std::string ros2_name(const TypeDescription& type);
/// A field as a line of a .msg file: "float64[] position". Types of `package` need no package.
std::string ros_field(const FieldDescription& field, const std::string& package);
/// The whole type as ROS tools read it from recordings and from Foxglove's protocol: its .msg
/// text, then those of all types in it, each after a line of 80 "=" and "MSG: package/Type".
/// Source: the encoding "ros2msg" of mcap.dev/spec/registry.
std::string ros_definition(const TypeDescription& type);

}  // namespace armature
