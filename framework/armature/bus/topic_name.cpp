// SPDX-License-Identifier: Apache-2.0
#include "armature/bus/topic_name.hpp"

namespace armature {

std::string dds_topic_name(const std::string& name) {
  if (name.starts_with("rt/")) return name;
  return name.starts_with('/') ? "rt" + name : "rt/" + name;
}

std::string ros_topic_name(const std::string& name) {
  return name.starts_with("rt/") ? name.substr(2) : name;
}

}  // namespace armature
