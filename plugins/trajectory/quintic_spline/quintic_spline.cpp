// SPDX-License-Identifier: Apache-2.0
#include "quintic_spline.hpp"

#include <utility>

#include "armature/kinds/trajectory/one_law.hpp"
#include "armature/kinds/trajectory/point_to_point.hpp"
#include "armature/robot/trajectories/quintic_spline.hpp"
#include "armature/runtime/plugins/plugin.hpp"

namespace armature::trajectory::quintic_spline {
namespace {

std::vector<Quintic> spline_along(const JointCurve& curve, const TimeLaw& law,
                                  std::span<const double> knots) {
  std::vector<JointVector> points;
  points.reserve(knots.size());
  for (const double t : knots) points.push_back(curve.at(law.s(t)).q);
  return armature::quintic_spline(knots, points, state_along(curve, law, knots.front()),
                                  state_along(curve, law, knots.back()));
}

}  // namespace

Expected<Trajectory> QuinticSplineTrajectory::plan(const TrajectoryRequest& request) const {
  if (auto direct = point_to_point(request)) return std::move(*direct);
  return timed(request, under_one_law(spline_along));
}

}  // namespace armature::trajectory::quintic_spline

ARMATURE_PLUGIN(armature::trajectory::quintic_spline::QuinticSplineTrajectory);
