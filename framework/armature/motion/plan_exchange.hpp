// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string_view>

#include "armature/bus/sample.hpp"
#include "armature/robot/trajectories/trajectory.hpp"

namespace armature ARMATURE_EXPORT {

// What goes back and forth between the unit that owns the reference and the one that plans.

/// A plan is wanted for a goal: from where the reference will be at `start`.
struct PlanRequest {
  std::uint64_t goal_id = 0;
  std::uint64_t continues = 0;  // serial number of the reference that the plan leaves
  Time start;                   // when the plan shall take over
  JointState from;              // the reference's own q, v, a then
  Time since = {};              // when the trajectory began that holds then
};

/// What became of a request; goal, serial number and start are those of the request.
struct PlanAnswer {
  std::uint64_t goal_id = 0;
  std::uint64_t continues = 0;
  Time start;
  TrajectoryView trajectory;       // in the memory of `sample`
  SampleRef sample;                // holds it; none where something else does
  std::string_view stage, reason;  // which stage refused, and why; empty: there is a plan
  int stops_ahead = 0;             // of the goal's way, behind the trajectory's end
};

}  // namespace armature
