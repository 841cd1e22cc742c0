// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "armature/messages/armature_msgs.hpp"
#include "armature/messages/geometry.hpp"
#include "armature/robot/geometry/forbidden_zone.hpp"

namespace armature ARMATURE_EXPORT {

inline std::vector<ForbiddenZone> zones_of(const std::vector<msg::ForbiddenZone>& messages) {
  std::vector<ForbiddenZone> zones;
  for (const msg::ForbiddenZone& message : messages) {
    zones.push_back({message.name_(), to_eigen(message.from_()), to_eigen(message.to_()),
                     message.radius_(), message.tool_enters_()});
  }
  return zones;
}

inline void write_zones(const std::vector<ForbiddenZone>& zones,
                        std::vector<msg::ForbiddenZone>& messages) {
  messages.resize(zones.size());
  for (std::size_t i = 0; i < zones.size(); ++i) {
    messages[i].name_() = zones[i].name;
    assign(messages[i].from_(), zones[i].from);
    assign(messages[i].to_(), zones[i].to);
    messages[i].radius_(zones[i].radius_m);
    messages[i].tool_enters_(zones[i].tool_enters);
  }
}

}  // namespace armature
