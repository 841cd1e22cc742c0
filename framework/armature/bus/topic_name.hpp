// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <string_view>

namespace armature ARMATURE_EXPORT {

/// "/a/b" or "a/b" -> "rt/a/b", as ROS 2 names its topics in DDS; "rt/a/b" stays.
std::string dds_topic_name(const std::string& name);
/// "rt/a/b" -> "/a/b"; other names stay.
std::string ros_topic_name(const std::string& name);
/// The deployment whose topic `name` it is: "dental_lamp" of "rt/dental_lamp/description" and
/// "description". Empty: it is another topic.
std::string deployment_of(std::string_view topic, std::string_view name);

}  // namespace armature
