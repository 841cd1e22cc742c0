// SPDX-License-Identifier: Apache-2.0
#include "armature/kinds/trajectory/one_law.hpp"

#include <algorithm>
#include <cmath>

namespace armature {
namespace {

/// The times of all waypoints, and between them as many more as it takes to have no gap longer than
/// if they were even: where the law is slow, waypoints even in s lie far apart in time.
std::vector<double> knots_of(const JointCurve& curve, const TimeLaw& law) {
  constexpr double kRounding = 1e-9;
  const double even = law.duration_s() / static_cast<double>(curve.s().size() - 1);
  std::vector<double> knots{0};
  for (std::size_t i = 1; i < curve.s().size(); ++i) {
    const double before = knots.back(), behind = law.time_at(curve.s()[i]);
    const int parts = static_cast<int>(std::ceil((behind - before) / even - kRounding));
    for (int k = 1; k < parts; ++k) knots.push_back(before + (behind - before) * k / parts);
    knots.push_back(behind);
  }
  return knots;
}

class UnderOneLaw final : public LegShape {
 public:
  UnderOneLaw(const TrajectoryRequest& request, const Leg& leg, PiecesAlong pieces_along)
      : request_{request}, leg_{leg}, pieces_along_{pieces_along} {}

  Trajectory in(double duration_s, const JointState& from) const override {
    return at_rest(from) ? along(TimeLaw{duration_s}) : from_moving(duration_s, from);
  }

 private:
  Trajectory along(const TimeLaw& law) const {
    Trajectory trajectory{.goal_id = request_.goal_id,
                          .dof = leg_.curve.dof(),
                          .start = request_.start,
                          .pieces = {}};
    trajectory.knots = knots_of(leg_.curve, law);
    trajectory.pieces = pieces_along_(leg_.curve, law, trajectory.knots);
    return trajectory;
  }

  /// The time law takes over what it can; the rest fades out in an added quintic. On a straight
  /// line with a fade as long as the leg the sum is the one quintic from the start's state to rest,
  /// so that planning again on the way changes nothing.
  Trajectory from_moving(double duration_s, const JointState& from) const {
    const JointState slope = leg_.curve.at(0);
    const double steepness = slope.v.squaredNorm();
    double speed = 0, acceleration = 0;
    if (steepness > 0) {
      speed = from.v.dot(slope.v) / steepness;
      acceleration = (from.a - speed * speed * slope.a).dot(slope.v) / steepness;
    }
    const TimeLaw law{duration_s, speed, acceleration};
    const JointVector rest = from.v - law.speed(0) * slope.v;
    // A quintic that fades v out in B peaks at 3.94 v/B: half of the limit is enough for it.
    const double stopping = rest.cwiseAbs().cwiseQuotient(request_.max_acceleration).maxCoeff();
    const double gentle = std::max(8 * stopping, 0.5 * duration_s);
    return spliced(along(law), from, std::min(duration_s, gentle));
  }

  const TrajectoryRequest& request_;
  const Leg& leg_;
  PiecesAlong pieces_along_;
};

}  // namespace

JointState state_along(const JointCurve& curve, const TimeLaw& law, double t) {
  const double speed = law.speed(t);
  JointState state = curve.at(law.s(t));
  state.a = speed * speed * state.a + law.acceleration(t) * state.v;
  state.v *= speed;
  return state;
}

LegShaper under_one_law(PiecesAlong pieces_along) {
  return [pieces_along](const TrajectoryRequest& request, const Leg& leg) {
    return std::make_unique<UnderOneLaw>(request, leg, pieces_along);
  };
}

}  // namespace armature
