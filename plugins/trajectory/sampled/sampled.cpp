// SPDX-License-Identifier: Apache-2.0
#include "sampled.hpp"

#include <utility>

#include "armature/kinds/trajectory/point_to_point.hpp"
#include "armature/kinds/trajectory/timing.hpp"
#include "armature/robot/trajectories/quintic_spline.hpp"
#include "armature/runtime/plugins/plugin.hpp"

namespace armature::trajectory::sampled {
namespace {

class SampledLeg final : public LegShape {
 public:
  SampledLeg(const TrajectoryRequest& request, const Leg& leg) : request_{request}, leg_{leg} {}

  Trajectory in(double duration_s, const JointState& from) const override {
    const auto& waypoints = leg_.curve.waypoints();
    const JointVector zero = JointVector::Zero(from.q.size());
    Trajectory trajectory{.goal_id = request_.goal_id,
                          .dof = leg_.curve.dof(),
                          .start = request_.start,
                          .knots = leg_.curve.s(),
                          .pieces = {}};
    for (double& knot : trajectory.knots) knot *= duration_s;
    trajectory.pieces =
        armature::quintic_spline(trajectory.knots, waypoints, from, {waypoints.back(), zero, zero});
    return trajectory;
  }

 private:
  const TrajectoryRequest& request_;
  const Leg& leg_;
};

}  // namespace

Expected<Trajectory> SampledTrajectory::plan(const TrajectoryRequest& request) const {
  if (auto direct = point_to_point(request)) return std::move(*direct);
  return timed(request, [](const TrajectoryRequest& asked, const Leg& leg) {
    return std::make_unique<SampledLeg>(asked, leg);
  });
}

}  // namespace armature::trajectory::sampled

ARMATURE_PLUGIN(armature::trajectory::sampled::SampledTrajectory);
