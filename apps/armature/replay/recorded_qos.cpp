// SPDX-License-Identifier: Apache-2.0
#include "replay/recorded_qos.hpp"

#include <optional>
#include <string>

namespace armature {
namespace {

/// What nobody who comes later would get twice: of recordings that do not say how a topic was sent.
bool is_latched(const std::string& topic) {
  return topic.ends_with("/description") || topic.ends_with("/robot_description") ||
         topic.ends_with("/tf_static") || topic.ends_with("/camera_info");
}

}  // namespace

QosProfile replayed_profile(const McapChannel& channel) {
  const auto told = channel.metadata.find("qos");
  const auto profile =
      told == channel.metadata.end() ? std::nullopt : find_qos_profile(told->second);
  if (!profile) return is_latched(channel.topic) ? QosProfile::latched : QosProfile::state;
  return *profile == QosProfile::command || *profile == QosProfile::reply ? QosProfile::state
                                                                          : *profile;
}

}  // namespace armature
