// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "armature/kinds/trajectory/joint_curve.hpp"
#include "armature/kinds/trajectory/trajectory_planner.hpp"
#include "armature/values/expected.hpp"

namespace armature ARMATURE_EXPORT {

inline constexpr double kStillWay = 1e-12;  // [rad] or [m]: no motion
inline constexpr double kLongest_s = 1e6;   // of a leg: twelve days

/// The joint path from one stop to the next: one segment, or several joined at vias.
struct Leg {
  std::size_t first_segment = 0;  // of the request
  JointCurve curve;
  bool moves = true;                 // false: all waypoints are the same
  std::optional<double> duration_s;  // the path's own
};

/// Whether the joints move by more than kStillWay.
bool moves(const JointSegment& segment);

/// What contradicts itself in a request, or "".
std::string defect_of(const TrajectoryRequest& request);

/// The request's segments put together from stop to stop; a leg that neither moves nor lasts is
/// left out. Refuses a request that contradicts itself.
Expected<std::vector<Leg>> legs_of(const TrajectoryRequest& request);

}  // namespace armature
