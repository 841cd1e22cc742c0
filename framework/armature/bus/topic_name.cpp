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

std::string deployment_of(std::string_view topic, std::string_view name) {
  constexpr std::string_view kRoot = "rt/";
  if (!topic.starts_with(kRoot)) return "";
  topic.remove_prefix(kRoot.size());
  const std::size_t slash = topic.find('/');
  const bool is_it = slash != std::string_view::npos && topic.substr(slash + 1) == name;
  return is_it ? std::string{topic.substr(0, slash)} : "";
}

}  // namespace armature
