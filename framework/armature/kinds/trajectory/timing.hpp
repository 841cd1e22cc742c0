// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <memory>

#include "armature/kinds/trajectory/legs.hpp"
#include "armature/kinds/trajectory/trajectory_planner.hpp"

namespace armature ARMATURE_EXPORT {

inline constexpr double kShortestLeg_s = 0.02;
inline constexpr double kLimitRounding = 1e-9;  // part of a limit that is not told from rounding

/// What distinguishes one trajectory plugin from another: how it follows one leg. From rest, twice
/// the time must be the same motion at half the speed.
class LegShape {
 public:
  virtual ~LegShape() = default;
  /// From `from`, which may move, to rest at the leg's end in exactly `duration_s`, without a jump
  /// in q, v or a and through all waypoints, whatever the limits.
  virtual Trajectory in(double duration_s, const JointState& from) const = 0;
};
/// Of a leg of a request, both of which outlive it.
using LegShaper = std::function<std::unique_ptr<LegShape>(const TrajectoryRequest&, const Leg&)>;

/// The fastest trajectory within the limits that goes from stop to stop in the given shapes, or in
/// the path's own durations.
Expected<Trajectory> timed(const TrajectoryRequest& request, const LegShaper& shape_of);

/// By how much slower a motion from rest has to be to keep the request's limits: velocities fall
/// with the factor, accelerations with its square, jerks with its cube.
double needed_factor(const TrajectoryRequest& request, const Trajectory& from_rest);

}  // namespace armature
