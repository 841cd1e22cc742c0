// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "armature/robot/geometry/forbidden_zone.hpp"
#include "armature/robot/geometry/pose_goal.hpp"
#include "armature/values/expected.hpp"
#include "armature/values/inline_text.hpp"

namespace armature ARMATURE_EXPORT {

/// How a goal is to be reached.
enum class MotionMode {
  planned,   // along a path, to rest
  tracking,  // a target that moves; the next goal follows soon
  hold,      // stop within limits and stay
  guided,    // stop within limits, then let a hand move the arm: the reference is where it is
  pause,     // stop on the way of a planned goal, and stay there; else as hold
  resume,    // go on along it
  retrace,   // go back along it, as it came
};

/// What the arm shall do next.
struct MotionGoal {
  std::uint64_t id = 0;
  MotionMode mode = MotionMode::planned;
  ToolPose pose;                                       // of the tool, in the base frame
  std::optional<Eigen::Vector3d> focus;                // [m] to look at on the way
  std::vector<ForbiddenZone> forbidden = {};           // to keep away from, planned only
  Eigen::Vector3d velocity = Eigen::Vector3d::Zero();  // [m/s] of the pose, tracking only
  Eigen::Vector3d angular_velocity =
      Eigen::Vector3d::Zero();         // [rad/s] in the base frame, the same
  std::vector<ToolPose> through = {};  // key poses on the way, in order; planned only
  /// Done where the way next stops, as a path says it does; planned, resume and retrace only. The
  /// whole way has been planned then, and `resume` goes on.
  bool stepwise = false;
  double max_speed = 0;  // [m/s] of the tool's position, on the whole way; 0: any; planned only
};

/// Whether a goal of that mode says where the tool shall be.
inline bool has_pose(MotionMode mode) {
  return mode == MotionMode::planned || mode == MotionMode::tracking;
}

/// What the motion component said about a goal.
struct GoalReport {
  enum class State : std::uint8_t { accepted = 0, executing, done, superseded, failed };
  std::uint64_t goal_id = 0;
  State state = State::accepted;
  std::string stage = {}, reason = {};
  int stops_ahead = 0;
};

/// Stage of a goal that has failed because the arm was stopped until it is rearmed: a stop drops
/// the goals that there are, and those that come while it lasts. Before the first goal was taken
/// nothing has been stopped; goals then fail in stage accept.
inline constexpr std::string_view kStopStage = "stop";

/// Whether `id` is that of a newer goal than `last`. Numbers up to a thousand behind are old; one
/// farther away is where somebody else began to count, so that no jump locks anybody out.
inline bool is_newer(std::uint64_t id, std::uint64_t last) { return last - id >= 1000; }

/// What is wrong with `goal`, its key poses and forbidden zones aside, or empty: a number that is
/// not finite, a direction or quaternion whose length is not 1 within 1 %. Real-time safe.
ReasonText defect(const MotionGoal& goal);

/// `goal` with a unit direction or quaternion, or why it cannot be used: a number that is not
/// finite, a direction or quaternion whose length is not 1 within 1 %, key poses or forbidden zones
/// for a motion that has no path.
Expected<MotionGoal> checked(MotionGoal goal);

}  // namespace armature
