// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>

#include "armature/messages/armature_msgs.hpp"
#include "armature/messages/geometry.hpp"
#include "armature/robot/geometry/thread.hpp"

namespace armature ARMATURE_EXPORT {

/// None while nothing turns.
inline std::optional<Thread> thread_of(const msg::ThreadAxis& message) {
  if (!message.engaged_()) return std::nullopt;
  return Thread{.start = to_eigen(message.start_()),
                .axis = to_eigen(message.axis_()),
                .pitch_m = message.pitch_()};
}

inline void write_thread(const std::optional<Thread>& thread, msg::ThreadAxis& message) {
  message.engaged_(thread.has_value());
  if (!thread) return;
  assign(message.start_(), thread->start);
  assign(message.axis_(), thread->axis);
  message.pitch_(thread->pitch_m);
}

}  // namespace armature
