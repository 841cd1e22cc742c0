// SPDX-License-Identifier: Apache-2.0
#include "quintic.hpp"

#include <utility>

#include "armature/kinds/trajectory/one_law.hpp"
#include "armature/kinds/trajectory/point_to_point.hpp"
#include "armature/runtime/plugins/plugin.hpp"

namespace armature::trajectory::quintic {
namespace {

std::vector<Quintic> hermite_along(const JointCurve& curve, const TimeLaw& law,
                                   std::span<const double> knots) {
  std::vector<Quintic> pieces;
  pieces.reserve((knots.size() - 1) * static_cast<std::size_t>(curve.dof()));
  JointState from = state_along(curve, law, knots.front());
  for (std::size_t i = 1; i < knots.size(); ++i) {
    const JointState to = state_along(curve, law, knots[i]);
    for (int j = 0; j < curve.dof(); ++j) {
      pieces.push_back(Quintic::between({from.q[j], from.v[j], from.a[j]},
                                        {to.q[j], to.v[j], to.a[j]}, knots[i] - knots[i - 1]));
    }
    from = to;
  }
  return pieces;
}

}  // namespace

Expected<Trajectory> QuinticTrajectory::plan(const TrajectoryRequest& request) const {
  if (auto direct = point_to_point(request)) return std::move(*direct);
  return timed(request, under_one_law(hermite_along));
}

}  // namespace armature::trajectory::quintic

ARMATURE_PLUGIN(armature::trajectory::quintic::QuinticTrajectory);
