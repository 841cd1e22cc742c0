// SPDX-License-Identifier: Apache-2.0
#include "armature/robot/trajectories/retiming.hpp"

#include <algorithm>
#include <cmath>

namespace armature {
namespace {

constexpr double kShortestRamp_s = 0.02, kLongestRamp_s = 10, kLonger = 1.25;
constexpr double kDelay_s = 0.01;  // between two places where a brake may begin
constexpr double kPiece_s = 0.005;
constexpr double kSamePlace_s = 1e-6;
constexpr int kSamples = 32;            // of a ramp, before its extrema are looked at
constexpr double kRounding = 1e-6;      // of limits
constexpr double kPlanRounding = 1e-9;  // of what is planned

/// How time runs along a planned motion: a place on it [s], and how that changes.
struct Law {
  enum class Shape { up, down, rest_to_rest };  // down: from the planned speed to rest
  Shape shape = Shape::up;
  double from_s = 0;  // the place where it begins
  double gone_s = 0;  // from there to where it ends
  double lasts_s = 0;

  double end_s() const { return from_s + gone_s; }

  /// The driven state at `t` behind its begin.
  JointState at(const Trajectory& trajectory, double t) const {
    const double u = std::clamp(t / lasts_s, 0.0, 1.0), v = 1 - u;
    double share = 0, rate = 0, rate_change = 0;  // of gone_s, [1], [1/s]
    switch (shape) {
      case Shape::up:
        share = u * u * u * (2 - u);
        rate = u * u * (3 - 2 * u);
        rate_change = 6 * u * v / lasts_s;
        break;
      case Shape::down:
        share = 1 - v * v * v * (2 - v);
        rate = v * v * (3 - 2 * v);
        rate_change = -6 * u * v / lasts_s;
        break;
      case Shape::rest_to_rest:
        share = u * u * u * (10 - u * (15 - 6 * u));
        rate = 30 * u * u * v * v * gone_s / lasts_s;
        rate_change = 60 * u * v * (v - u) * gone_s / (lasts_s * lasts_s);
        break;
    }
    JointState state = state_at(trajectory.view(), from_s + share * gone_s);
    state.a = state.a * rate * rate + state.v * rate_change;
    state.v *= rate;
    return state;
  }
};

/// A smooth step of the speed, over which half of the way is gone that the planned speed would go.
Law ramp(Law::Shape shape, double from_s, double lasts_s) {
  return {.shape = shape, .from_s = from_s, .gone_s = lasts_s / 2, .lasts_s = lasts_s};
}

/// The limits, or what the planned motion itself needs where that is more: the check of a
/// trajectory lets it use a little more, and no ramp from there keeps the limits alone.
MotionLimits allowed(const Trajectory& trajectory, const MotionLimits& limits) {
  MotionLimits most = limits;
  most.max_velocity *= 1 + kRounding;
  most.max_acceleration *= 1 + kRounding;
  for (int k = 0; k < trajectory.piece_count(); ++k) {
    const auto knot = trajectory.knots.begin() + k;
    for (int j = 0; j < trajectory.dof; ++j) {
      const QuinticPeaks peak = peaks(trajectory.view().piece(k, j), *(knot + 1) - *knot);
      most.max_velocity[j] = std::max(most.max_velocity[j], (1 + kPlanRounding) * peak.velocity);
      most.max_acceleration[j] =
          std::max(most.max_acceleration[j], (1 + kPlanRounding) * peak.acceleration);
    }
  }
  return most;
}

bool within(const JointState& state, const MotionLimits& most) {
  return (state.v.cwiseAbs().array() <= most.max_velocity.array()).all() &&
         (state.a.cwiseAbs().array() <= most.max_acceleration.array()).all();
}

Trajectory pieces_of(const Trajectory& trajectory, const Law& law) {
  Trajectory driven{.goal_id = trajectory.goal_id,
                    .dof = trajectory.dof,
                    .start = trajectory.start,
                    .knots = {0},
                    .pieces = {}};
  const int pieces = std::max(8, static_cast<int>(std::ceil(law.lasts_s / kPiece_s)));
  const double piece_s = law.lasts_s / pieces;
  JointState from = law.at(trajectory, 0);
  for (int k = 1; k <= pieces; ++k) {
    const JointState to = law.at(trajectory, k * piece_s);
    for (Eigen::Index j = 0; j < trajectory.dof; ++j) {
      driven.pieces.push_back(Quintic::between({from.q[j], from.v[j], from.a[j]},
                                               {to.q[j], to.v[j], to.a[j]}, piece_s));
    }
    driven.knots.push_back(k * piece_s);
    from = to;
  }
  return driven;
}

/// What the law makes of a motion, if that is allowed: by samples first, then by its extrema.
std::optional<Trajectory> driven(const Trajectory& trajectory, const Law& law,
                                 const MotionLimits& most) {
  for (int i = 0; i <= kSamples; ++i) {
    if (!within(law.at(trajectory, law.lasts_s * i / kSamples), most)) return std::nullopt;
  }
  Trajectory made = pieces_of(trajectory, law);
  const LimitUse use = limit_use(made, most.max_velocity, most.max_acceleration);
  if (std::max(use.velocity, use.acceleration) > 1) return std::nullopt;
  return made;
}

std::optional<Retimed> brake_at(const Trajectory& trajectory, double at_s, double rest_s,
                                const MotionLimits& most) {
  for (double lasts = kShortestRamp_s; lasts <= kLongestRamp_s; lasts *= kLonger) {
    const Law law = ramp(Law::Shape::down, at_s, lasts);
    if (law.end_s() >= rest_s) return std::nullopt;
    if (auto made = driven(trajectory, law, most)) {
      return Retimed{std::move(*made), lasts, law.end_s()};
    }
  }
  return std::nullopt;
}

}  // namespace

Trajectory followed_by(Trajectory first, const Trajectory& second) {
  const double offset = first.duration_s();
  if (offset == 0) {
    first.knots = second.knots;
    first.pieces = second.pieces;
    return first;
  }
  for (std::size_t k = 1; k < second.knots.size(); ++k) {
    first.knots.push_back(offset + second.knots[k]);
  }
  first.pieces.insert(first.pieces.end(), second.pieces.begin(), second.pieces.end());
  return first;
}

Trajectory part(const Trajectory& trajectory, double from_s, double to_s) {
  const double end = trajectory.duration_s();
  const double from = std::clamp(from_s, 0.0, end), to = std::clamp(to_s, from, end);
  Trajectory cut{.goal_id = trajectory.goal_id,
                 .dof = trajectory.dof,
                 .start = trajectory.start,
                 .pieces = {}};
  for (int k = 0; to - from > kSamePlace_s && k < trajectory.piece_count(); ++k) {
    const auto knot = trajectory.knots.begin() + k;
    const bool outside = *(knot + 1) <= from + kSamePlace_s || *knot >= to - kSamePlace_s;
    if (outside) continue;
    // What is left out beside a knot is gone by the piece on its other side.
    const double begin = cut.knots.empty() ? from : *knot;
    if (cut.knots.empty()) cut.knots.push_back(0);
    cut.knots.push_back(std::min(*(knot + 1), to) - from);
    for (int j = 0; j < trajectory.dof; ++j) {
      const Quintic& piece = trajectory.pieces[static_cast<std::size_t>(k * trajectory.dof + j)];
      cut.pieces.push_back(begin == *knot ? piece : piece.shifted(begin - *knot));
    }
  }
  if (!cut.knots.empty()) {
    cut.knots.back() = to - from;
    return cut;
  }
  return hold_at(state_at(trajectory.view(), from).q, trajectory.start, trajectory.goal_id);
}

Trajectory reversed(const Trajectory& trajectory) {
  Trajectory back = trajectory;
  const double end = trajectory.duration_s();
  const int pieces = trajectory.piece_count();
  for (std::size_t k = 0; k < trajectory.knots.size(); ++k) {
    back.knots[k] = end - trajectory.knots[trajectory.knots.size() - 1 - k];
  }
  for (int k = 0; k < pieces; ++k) {
    const auto from = static_cast<std::size_t>(pieces - 1 - k);
    const double lasts = trajectory.knots[from + 1] - trajectory.knots[from];
    for (int j = 0; j < trajectory.dof; ++j) {
      Quintic piece =
          trajectory
              .pieces[from * static_cast<std::size_t>(trajectory.dof) + static_cast<std::size_t>(j)]
              .shifted(lasts);
      for (const std::size_t odd : {1, 3, 5}) piece.c[odd] = -piece.c[odd];
      back.pieces[static_cast<std::size_t>(k * trajectory.dof + j)] = piece;
    }
  }
  return back;
}

double next_rest_s(const Trajectory& trajectory, double from_s) {
  for (const double knot : trajectory.knots) {
    if (knot <= from_s + kSamePlace_s) continue;
    if (at_rest(state_at(trajectory.view(), knot))) return knot;
  }
  return trajectory.duration_s();
}

Retimed brake(const Trajectory& trajectory, double from_s, const MotionLimits& limits) {
  from_s = std::clamp(from_s, 0.0, trajectory.duration_s());
  const double rest_s =
      at_rest(state_at(trajectory.view(), from_s)) ? from_s : next_rest_s(trajectory, from_s);
  const MotionLimits most = allowed(trajectory, limits);
  for (double at_s = from_s; at_s < rest_s; at_s += kDelay_s) {
    auto braked = brake_at(trajectory, at_s, rest_s, most);
    if (!braked) continue;
    if (at_s > from_s) {
      braked->trajectory = followed_by(part(trajectory, from_s, at_s), braked->trajectory);
    }
    return std::move(*braked);
  }
  return {.trajectory = part(trajectory, from_s, rest_s), .ramp_s = 0, .place_s = rest_s};
}

Retimed speed_up(const Trajectory& trajectory, double from_s, double to_s,
                 const MotionLimits& limits) {
  from_s = std::clamp(from_s, 0.0, trajectory.duration_s());
  to_s = std::min(to_s, trajectory.duration_s());
  if (to_s <= from_s) return {part(trajectory, from_s, from_s), 0, from_s};
  const MotionLimits most = allowed(trajectory, limits);
  for (double lasts = kShortestRamp_s; lasts <= kLongestRamp_s; lasts *= kLonger) {
    const Law law = ramp(Law::Shape::up, from_s, lasts);
    if (law.end_s() >= to_s) break;
    auto made = driven(trajectory, law, most);
    if (!made) continue;
    return {followed_by(std::move(*made), part(trajectory, law.end_s(), to_s)), lasts, law.end_s()};
  }
  for (Law law{Law::Shape::rest_to_rest, from_s, to_s - from_s, std::max(to_s - from_s, kPiece_s)};;
       law.lasts_s *= kLonger) {
    if (auto made = driven(trajectory, law, most)) {
      return {std::move(*made), law.lasts_s, to_s};
    }
  }
}

}  // namespace armature
