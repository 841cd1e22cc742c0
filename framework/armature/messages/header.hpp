// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>
#include <string_view>

#include "armature/messages/stamp.hpp"
#include "armature/messages/std_msgs.hpp"

namespace armature ARMATURE_EXPORT {

/// The frame at the foot of an arm, in which its poses are told.
inline constexpr std::string_view kBaseFrame = "base";

/// Writes a whole header; no frame for what lies in none. Real-time safe.
inline void write_header(msg::Header& header, Time stamp, std::string_view frame = {}) {
  set_stamp(header.stamp_(), stamp);
  header.frame_id_().assign(frame);
}

/// nullopt, or "the goal is stated in frame 'camera', not in 'base'" with `what` = "the goal".
inline std::optional<std::string> not_in_base(const msg::Header& header, std::string_view what) {
  if (header.frame_id_() == kBaseFrame) return std::nullopt;
  return std::string{what} + " is stated in frame '" + header.frame_id_() + "', not in '" +
         std::string{kBaseFrame} + "'";
}

}  // namespace armature
