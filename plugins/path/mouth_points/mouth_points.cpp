// SPDX-License-Identifier: Apache-2.0
#include "mouth_points.hpp"

#include <cmath>

#include "armature/runtime/plugins/plugin.hpp"

namespace armature::path::mouth_points {
namespace {

using Eigen::Vector3d;

constexpr double kSame = 1e-6;      // [m] and [rad]: two poses are one
constexpr double kOpposite = 1e-6;  // |u1 + u3| below which P2 is not defined

double angle(const Vector3d& a, const Vector3d& b) {
  return std::atan2(a.cross(b).norm(), a.dot(b));
}

/// The tool at `distance` from the mouth, looking at it along `u`.
ToolPose looking_along(const Vector3d& mouth, double distance, const Vector3d& u) {
  return {mouth - distance * u, Direction{u}};
}

bool same(const ToolPose& a, const ToolPose& b) {
  const Vector3d& u = std::get<Direction>(a.orientation).unit;
  return (a.position - b.position).norm() < kSame &&
         angle(u, std::get<Direction>(b.orientation).unit) < kSame;
}

}  // namespace

PathSegment MouthPoints::move_to(const ToolPose& end) const {
  const double duration_s = parameters_.segment;
  return {.space = PathSegment::Space::joint,
          .samples = {{1, end}},
          .stop_at_end = true,
          .duration_s = duration_s > 0 ? std::optional{duration_s} : std::nullopt};
}

Expected<Path> MouthPoints::plan(const PathRequest& request) const {
  const auto valid = checked(request);
  if (!valid) return tl::unexpected{valid.error()};
  const ToolPose &P0 = valid->start, &P3 = valid->goal;
  const auto& focus = valid->focus;
  if (!focus) return Path{move_to(P3)};
  if (!std::holds_alternative<Direction>(P0.orientation) ||
      !std::holds_alternative<Direction>(P3.orientation)) {
    return refuse("a goal with a point to look at needs a pointing direction, not a rotation");
  }
  const Vector3d& m = *focus;
  const double d = (P3.position - m).norm();
  if (d < kSame) return refuse("the goal lies on the point to look at");
  if ((P0.position - m).norm() < kSame) return refuse("the start lies on the point to look at");

  const Vector3d u1 = (m - P0.position).normalized();  // (44)
  const Vector3d u3 = (m - P3.position) / d;           // (46), = -n
  const Vector3d sum = u1 + u3;
  if (sum.norm() < kOpposite) {
    return refuse("the goal is on the opposite side of the point to look at: P2 has no direction");
  }
  const ToolPose P1 = looking_along(m, d, u1);                // (43)
  const ToolPose P2 = looking_along(m, d, sum.normalized());  // (45), (47)
  Path path;
  const ToolPose* last = &P0;
  for (const ToolPose* next : {&P1, &P2, &P3}) {
    const bool is_goal = next == &P3;
    const bool nearly_there = !is_goal && angle(u1, u3) < kSame;  // P1 = P2 = P3
    if (nearly_there || same(*last, *next)) continue;
    path.push_back(move_to(*next));
    last = next;
  }
  if (path.empty()) path.push_back(move_to(P3));
  return path;
}

}  // namespace armature::path::mouth_points

ARMATURE_PLUGIN(armature::path::mouth_points::MouthPoints);
