// SPDX-License-Identifier: Apache-2.0
#include "cubic_spline.hpp"

#include "armature/kinds/trajectory/timing.hpp"
#include "armature/robot/trajectories/cubic_spline.hpp"
#include "armature/runtime/plugins/plugin.hpp"
#include "knot_times.hpp"

namespace armature::trajectory::cubic_spline {
namespace {

JointState resting_at(const JointVector& q) {
  return {q, JointVector::Zero(q.size()), JointVector::Zero(q.size())};
}

/// The spline through a leg's waypoints at `share` (from 0 to 1) of its time.
Trajectory spline_at(const TrajectoryRequest& request, const Leg& leg,
                     const std::vector<double>& share, double duration_s, const JointState& from) {
  const auto& waypoints = leg.curve.waypoints();
  std::vector<double> times;
  times.reserve(share.size());
  for (const double part : share) times.push_back(part * duration_s);
  KnottedPieces spline =
      armature::cubic_spline(times, waypoints, from, resting_at(waypoints.back()));
  return {.goal_id = request.goal_id,
          .dof = leg.curve.dof(),
          .start = request.start,
          .knots = std::move(spline.knots),
          .pieces = std::move(spline.pieces)};
}

class CubicLeg final : public LegShape {
 public:
  CubicLeg(const TrajectoryRequest& request, const Leg& leg, int optimum_tries)
      : request_{request},
        leg_{leg},
        share_{best_knot_times(leg, request, optimum_tries, needed())} {}

  Trajectory in(double duration_s, const JointState& from) const override {
    return spline_at(request_, leg_, share_, duration_s, from);
  }

 private:
  KnotTimesNeed needed() const {
    return [this](const std::vector<double>& share) {
      const JointState rest = resting_at(leg_.curve.waypoints().front());
      return needed_factor(request_, spline_at(request_, leg_, share, 1, rest));
    };
  }

  const TrajectoryRequest& request_;
  const Leg& leg_;
  std::vector<double> share_;
};

}  // namespace

Expected<Trajectory> CubicSplineTrajectory::plan(const TrajectoryRequest& request) const {
  return timed(request, [this](const TrajectoryRequest& asked, const Leg& leg) {
    return std::make_unique<CubicLeg>(asked, leg, parameters_.optimum_tries);
  });
}

}  // namespace armature::trajectory::cubic_spline

ARMATURE_PLUGIN(armature::trajectory::cubic_spline::CubicSplineTrajectory);
