// SPDX-License-Identifier: Apache-2.0
#include "quintic_spline.hpp"

#include "armature/kinds/trajectory/timing.hpp"
#include "armature/robot/quintic_spline.hpp"
#include "armature/runtime/plugin.hpp"

namespace armature {
namespace {

std::vector<Quintic> spline_along(const JointCurve& curve, const TimeLaw& law,
                                  std::span<const double> knots) {
  return quintic_spline(knots, curve.waypoints(), state_along(curve, law, knots.front()),
                        state_along(curve, law, knots.back()));
}

}  // namespace

Expected<Trajectory> QuinticSplineTrajectory::plan(const TrajectoryRequest& request) const {
  return timed(request, spline_along);
}

}  // namespace armature

ARMATURE_PLUGIN(armature::QuinticSplineTrajectory);
