// SPDX-License-Identifier: Apache-2.0
#include "armature/kinds/trajectory/sound_trajectory.hpp"

#include <algorithm>

#include "armature/robot/trajectories/trajectory.hpp"

namespace armature {
namespace {

void check_limits(const Trajectory& trajectory, const TrajectoryRequest& request, LawCheck& check) {
  const auto at_start = [](const JointVector& rate, const JointVector& limit) {
    return std::max(1.0, rate.cwiseAbs().cwiseQuotient(limit).maxCoeff());
  };
  const LimitUse use = limit_use(trajectory, request.max_velocity, request.max_acceleration);
  check.at_most(use.velocity, at_start(request.from.v, request.max_velocity) + 1e-6,
                "the highest velocity over its limit");
  check.at_most(use.acceleration, at_start(request.from.a, request.max_acceleration) + 1e-6,
                "the highest acceleration over its limit");
  check.at_most(jerk_use(trajectory, request.max_jerk), 1 + 1e-6,
                "the highest jerk over its limit");
}

void check_ends(const Trajectory& trajectory, const TrajectoryRequest& request, LawCheck& check) {
  const JointState first = trajectory.at(request.start), last = trajectory.at(trajectory.end());
  check.at_most((first.q - request.from.q).norm(), 1e-9, "position beside the start [rad or m]");
  check.at_most((first.v - request.from.v).norm(), 1e-9, "velocity beside that of the start");
  check.at_most((first.a - request.from.a).norm(), 1e-8, "acceleration beside that of the start");
  check.at_most((last.q - request.segments.back().q.back()).norm(), 1e-9,
                "position beside the goal [rad or m]");
  check.at_most(last.v.norm(), 1e-7, "velocity at the end");
  check.at_most(last.a.norm(), 1e-6, "acceleration at the end");
}

void check_joints_between_pieces(const Trajectory& trajectory, LawCheck& check) {
  for (int k = 1; k < trajectory.piece_count(); ++k) {
    const double h = trajectory.knots[static_cast<std::size_t>(k)] -
                     trajectory.knots[static_cast<std::size_t>(k) - 1];
    for (int j = 0; j < trajectory.dof; ++j) {
      const auto piece = [&](int i) {
        return trajectory.pieces[static_cast<std::size_t>(i * trajectory.dof + j)];
      };
      check.near(piece(k - 1).position(h), piece(k).position(0), 1e-9,
                 "position where two pieces meet [rad or m]");
      check.near(piece(k - 1).velocity(h), piece(k).velocity(0), 1e-7,
                 "velocity where two pieces meet");
      check.near(piece(k - 1).acceleration(h), piece(k).acceleration(0), 1e-5,
                 "acceleration where two pieces meet");
    }
  }
}

}  // namespace

bool check_sound(const Expected<Trajectory>& planned, const TrajectoryRequest& request,
                 LawCheck& check) {
  if (!check.answered(planned, "a request that can be met")) return false;
  check.equal(planned->goal_id, request.goal_id, "the goal id");
  check.that(planned->start == request.start, "it starts when it was asked to");
  check_limits(*planned, request, check);
  check_ends(*planned, request, check);
  check_joints_between_pieces(*planned, check);
  return true;
}

}  // namespace armature
