// SPDX-License-Identifier: Apache-2.0
#include "mouth_arc.hpp"

#include <algorithm>
#include <cmath>

#include "armature/runtime/plugin.hpp"

namespace armature {
namespace {

constexpr int kFewestSteps = 8;
constexpr double kNothing = 1e-9;  // [m] or [rad]: no motion at all

PathSegment joint_move(const ToolPose& end) {
  return {.space = PathSegment::Space::joint,
          .samples = {{1, end}},
          .stop_at_end = true,
          .duration_s = {}};
}

}  // namespace

Expected<std::unique_ptr<PathPlanner>> MouthArc::make(const Params& params) {
  return std::unique_ptr<PathPlanner>{new MouthArc{params}};
}

MouthArc::MouthArc(const Params& params)
    : step_{params.number("step_deg")},
      near_m_{params.number("near_mm")},
      near_rad_{params.number("near_deg")} {}

/// The swing as a cartesian segment; `turn` [rad] is the largest turn on the way.
PathSegment MouthArc::along(const Swing& swing, const ToolPose& goal, double turn) const {
  const int steps = std::max(kFewestSteps, static_cast<int>(std::ceil(turn / step_)));
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
  if (!request.focus) return Path{joint_move(request.goal)};
  const auto* start_direction = std::get_if<Direction>(&request.start.orientation);
  const auto* goal_direction = std::get_if<Direction>(&request.goal.orientation);
  if (!start_direction || !goal_direction) {
    return refuse("a goal with a point to look at needs a pointing direction, not a rotation");
  }
  const Eigen::Vector3d& focus = *request.focus;
  if ((request.goal.position - focus).norm() < kNothing) {
    return refuse("the goal lies on the point to look at");
  }
  if ((request.start.position - focus).norm() < kNothing) return Path{joint_move(request.goal)};

  const View goal = view_of(focus, request.goal.position, goal_direction->unit);
  const View start = view_of(focus, request.start.position, start_direction->unit);
  if (std::abs(start.distance - goal.distance) <= near_m_ && start.miss_angle() <= near_rad_) {
    const Swing swing{focus, start, goal};  // small corrections: all at once
    const double turn = swing.angle() + start.miss_angle() + goal.miss_angle();
    return Path{along(swing, request.goal, turn)};
  }
  const View approach{goal.distance, start.outward, Eigen::Vector3d::Zero()};  // P1, (43)
  const Swing swing{focus, approach, goal};
  if (swing.angle() < step_) return Path{joint_move(request.goal)};
  return Path{joint_move({swing.position(0), Direction{swing.direction(0)}}),
              along(swing, request.goal, swing.angle() + goal.miss_angle())};
}

}  // namespace armature

ARMATURE_PLUGIN(armature::MouthArc);
