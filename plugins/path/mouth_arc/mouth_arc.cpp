// SPDX-License-Identifier: Apache-2.0
#include "mouth_arc.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "armature/runtime/plugins/plugin.hpp"

namespace armature::path::mouth_arc {
namespace {

constexpr int kFewestSteps = 8;
constexpr double kNothing = 1e-9;  // [m] or [rad]: no motion at all
// [rad] between a goal's direction and the way to its focus: beyond, the miss that fades along the
// arc would pass through no direction at all.
constexpr double kMaxMiss = std::numbers::pi / 2;

PathSegment joint_move(const ToolPose& end) {
  return {.space = PathSegment::Space::joint,
          .samples = {{1, end}},
          .stop_at_end = true,
          .duration_s = {}};
}

}  // namespace

/// The swing as a cartesian segment; `turn` [rad] is the largest turn on the way.
PathSegment MouthArc::along(const Swing& swing, const ToolPose& goal, double turn) const {
  const int steps = std::max(kFewestSteps, static_cast<int>(std::ceil(turn / parameters_.step)));
  PathSegment segment;
  segment.space = PathSegment::Space::cartesian;
  for (int i = 0; i <= steps; ++i) {
    const double s = static_cast<double>(i) / steps;
    segment.samples.push_back({s, {swing.position(s), Direction{swing.direction(s)}}});
  }
  segment.samples.back().pose = goal;
  return segment;
}

Expected<Path> MouthArc::plan(const PathRequest& request) const {
  const auto valid = checked(request);
  if (!valid) return tl::unexpected{valid.error()};
  const ToolPose &from = valid->start, &to = valid->goal;
  const auto& focus = valid->focus;
  if (!focus) return Path{joint_move(to)};
  const auto* from_direction = std::get_if<Direction>(&from.orientation);
  const auto* to_direction = std::get_if<Direction>(&to.orientation);
  if (!from_direction || !to_direction) {
    return refuse("a goal with a point to look at needs a pointing direction, not a rotation");
  }
  if ((to.position - *focus).norm() < kNothing) {
    return refuse("the goal lies on the point to look at");
  }
  if ((from.position - *focus).norm() < kNothing) return Path{joint_move(to)};

  const View goal = view_of(*focus, to.position, to_direction->unit);
  if (goal.miss_angle() > kMaxMiss) {
    return refuse("the goal looks away from the point to look at");
  }
  const View start = view_of(*focus, from.position, from_direction->unit);
  if (std::abs(start.distance - goal.distance) <= parameters_.near_m &&
      start.miss_angle() <= parameters_.near_rad) {
    const Swing swing{*focus, start, goal};  // small corrections: all at once
    const double turn = swing.angle() + start.miss_angle() + goal.miss_angle();
    return Path{along(swing, to, turn)};
  }
  const View approach{goal.distance, start.outward, Eigen::Vector3d::Zero()};  // P1, (43)
  const Swing swing{*focus, approach, goal};
  if (swing.angle() < parameters_.step) return Path{joint_move(to)};
  return Path{joint_move({swing.position(0), Direction{swing.direction(0)}}),
              along(swing, to, swing.angle() + goal.miss_angle())};
}

}  // namespace armature::path::mouth_arc

ARMATURE_PLUGIN(armature::path::mouth_arc::MouthArc);
