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
/// The frame in which points of images, and plans that are made on them, are told.
inline constexpr std::string_view kImageFrame = "image";

/// Writes a whole header; no frame for what lies in none. Real-time safe.
inline void write_header(msg::Header& header, Time stamp, std::string_view frame = {}) {
  set_stamp(header.stamp_(), stamp);
  header.frame_id_().assign(frame);
}

/// nullopt, or "the plan is stated in frame 'jaw', not in 'image'" with `what` = "the plan is".
inline std::optional<std::string> not_in_frame(const msg::Header& header, std::string_view frame,
                                               std::string_view what) {
  if (header.frame_id_() == frame) return std::nullopt;
  return std::string{what} + " stated in frame '" + header.frame_id_() + "', not in '" +
         std::string{frame} + "'";
}

/// nullopt, or "the goal is stated in frame 'camera', not in 'base'" with `what` = "the goal".
inline std::optional<std::string> not_in_base(const msg::Header& header, std::string_view what) {
  return not_in_frame(header, kBaseFrame, std::string{what} + " is");
}

}  // namespace armature
