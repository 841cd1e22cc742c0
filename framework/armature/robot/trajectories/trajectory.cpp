// SPDX-License-Identifier: Apache-2.0
#include "armature/robot/trajectories/trajectory.hpp"

#include <algorithm>
#include <cmath>

namespace armature {
namespace {

constexpr double kShortestBlend_s = 1e-3;
constexpr double kSameKnot_s = 1e-6;  // a blend that ends this close to a knot ends on it

/// A piece and the time in it.
struct Place {
  int piece = 0;
  double t = 0;
};

static_assert(sizeof(Quintic) == 6 * sizeof(double), "pieces are read as rows of coefficients");

/// Where `t` (from the trajectory's start) falls; clamped to the ends. Needs a piece.
Place place_of(std::span<const double> knots, double t) {
  const double inside = std::clamp(t, 0.0, knots.back());
  const auto next = std::upper_bound(knots.begin() + 1, knots.end() - 1, inside);
  const int piece = static_cast<int>(next - knots.begin()) - 1;
  return {piece, inside - knots[static_cast<std::size_t>(piece)]};
}

const Quintic& piece_of(const Trajectory& trajectory, int piece, int joint) {
  return trajectory.pieces[static_cast<std::size_t>(piece * trajectory.dof + joint)];
}

/// What a quintic's coefficients are multiplied with for its value and first two derivatives at t.
struct Powers {
  using Row = Eigen::Matrix<double, 6, 1>;
  Row value, first, second;

  explicit Powers(double t) {
    const double t2 = t * t, t3 = t2 * t, t4 = t2 * t2;
    value << 1, t, t2, t3, t4, t4 * t;
    first << 0, 1, 2 * t, 3 * t2, 4 * t3, 5 * t4;
    second << 0, 0, 2, 6 * t, 12 * t2, 20 * t3;
  }
};

/// The same motion with a knot at `t` too: a piece that holds `t` is split, one is appended that
/// stays at the end when `t` is behind it.
Trajectory with_knot_at(Trajectory trajectory, double t) {
  auto& [id, dof, start, knots, pieces] = trajectory;
  const auto after = std::upper_bound(knots.begin(), knots.end(), t);
  if (*(after - 1) == t) return trajectory;
  const auto piece = after - knots.begin() - 1;  // the one before `t`
  std::vector<Quintic> rest(static_cast<std::size_t>(dof));
  for (int j = 0; j < dof; ++j) {
    auto& behind = rest[static_cast<std::size_t>(j)];
    if (after == knots.end())
      behind.c[0] = piece_of(trajectory, static_cast<int>(piece) - 1, j)
                        .position(knots.back() - knots[static_cast<std::size_t>(piece) - 1]);
    else
      behind = piece_of(trajectory, static_cast<int>(piece), j)
                   .shifted(t - knots[static_cast<std::size_t>(piece)]);
  }
  const auto where = after == knots.end() ? piece : piece + 1;
  pieces.insert(pieces.begin() + where * dof, rest.begin(), rest.end());
  knots.insert(after, t);
  return trajectory;
}

}  // namespace

JointState state_at(const TrajectoryView& trajectory, double t) {
  JointState state{JointVector(trajectory.dof), JointVector(trajectory.dof),
                   JointVector(trajectory.dof)};
  if (trajectory.piece_count() == 0) {
    for (JointVector* values : {&state.q, &state.v, &state.a}) values->setZero();
    return state;
  }
  const Place place = place_of(trajectory.knots, t);
  const Powers at{place.t};
  for (int j = 0; j < trajectory.dof; ++j) {
    const Eigen::Map<const Powers::Row> c{trajectory.coefficients +
                                          6 * (place.piece * trajectory.dof + j)};
    state.q[j] = at.value.dot(c);
    state.v[j] = at.first.dot(c);
    state.a[j] = at.second.dot(c);
  }
  return state;
}

JointState TrajectoryView::at(Time time) const {
  // end() is rounded to nanoseconds; from there on it is the end itself, not half a one before it.
  return state_at(*this, time >= end() ? duration_s() : to_seconds(time - start));
}

Quintic TrajectoryView::piece(int k, int joint) const {
  Quintic quintic;
  std::copy_n(coefficients + 6 * (k * dof + joint), quintic.c.size(), quintic.c.begin());
  return quintic;
}

TrajectoryView Trajectory::view() const {
  const bool whole =
      !pieces.empty() && pieces.size() == static_cast<std::size_t>(piece_count() * dof);
  return {goal_id, dof, start, whole ? std::span<const double>{knots} : std::span<const double>{},
          whole ? pieces.front().c.data() : nullptr};
}

JointState Trajectory::at(Time time) const { return view().at(time); }

JointVector Trajectory::jerk_at(Time time) const {
  JointVector jerk = JointVector::Zero(dof);
  const double t = to_seconds(time - start);
  if (piece_count() == 0 || t < 0 || t > duration_s()) return jerk;
  const Place place = place_of(knots, t);
  for (int j = 0; j < dof; ++j) jerk[j] = piece_of(*this, place.piece, j).jerk(place.t);
  return jerk;
}

Trajectory to_trajectory(const TrajectoryView& view) {
  Trajectory copy{.goal_id = view.goal_id,
                  .dof = view.dof,
                  .start = view.start,
                  .knots = {view.knots.begin(), view.knots.end()},
                  .pieces = {}};
  for (int k = 0; k < view.piece_count(); ++k) {
    for (int j = 0; j < view.dof; ++j) copy.pieces.push_back(view.piece(k, j));
  }
  return copy;
}

Trajectory hold_at(const JointVector& q, Time start, std::uint64_t goal_id) {
  Trajectory hold{.goal_id = goal_id,
                  .dof = static_cast<int>(q.size()),
                  .start = start,
                  .knots = {0, 0},
                  .pieces = {}};
  for (const double value : q) hold.pieces.push_back({{value}});
  return hold;
}

LimitUse limit_use(const Trajectory& trajectory, const JointVector& max_velocity,
                   const JointVector& max_acceleration) {
  LimitUse use;
  for (int k = 0; k < trajectory.piece_count(); ++k) {
    const auto knot = trajectory.knots.begin() + k;
    for (int j = 0; j < trajectory.dof; ++j) {
      const QuinticPeaks peak = peaks(piece_of(trajectory, k, j), *(knot + 1) - *knot);
      use.velocity = std::max(use.velocity, peak.velocity / max_velocity[j]);
      use.acceleration = std::max(use.acceleration, peak.acceleration / max_acceleration[j]);
    }
  }
  return use;
}

double jerk_use(const Trajectory& trajectory, const JointVector& max_jerk) {
  double use = 0;
  if (max_jerk.size() == 0) return use;
  for (int k = 0; k < trajectory.piece_count(); ++k) {
    const auto knot = trajectory.knots.begin() + k;
    for (int j = 0; j < trajectory.dof; ++j) {
      const double peak = peak_jerk(piece_of(trajectory, k, j), *(knot + 1) - *knot);
      use = std::max(use, peak / max_jerk[j]);
    }
  }
  return use;
}

Trajectory stretched(const Trajectory& trajectory, double factor) {
  Trajectory slower = trajectory;
  for (double& knot : slower.knots) knot *= factor;
  for (Quintic& quintic : slower.pieces) {
    double scale = 1;
    for (double& c : quintic.c) {
      c /= scale;
      scale *= factor;
    }
  }
  return slower;
}

Trajectory spliced(const Trajectory& trajectory, const JointState& from, double blend_s) {
  if (trajectory.piece_count() == 0) return trajectory;
  double blend = std::max(blend_s, kShortestBlend_s);
  for (const double knot : trajectory.knots)
    if (std::abs(knot - blend) < kSameKnot_s) blend = knot;

  const JointState planned = state_at(trajectory.view(), 0);
  Trajectory result = with_knot_at(trajectory, blend);
  for (int j = 0; j < result.dof; ++j) {
    const Quintic difference = Quintic::between(
        {from.q[j] - planned.q[j], from.v[j] - planned.v[j], from.a[j] - planned.a[j]}, {}, blend);
    for (int k = 0; k < result.piece_count(); ++k) {
      const double knot = result.knots[static_cast<std::size_t>(k)];
      if (knot >= blend) break;
      const Quintic added = difference.shifted(knot);
      Quintic& quintic = result.pieces[static_cast<std::size_t>(k * result.dof + j)];
      for (std::size_t i = 0; i < 6; ++i) quintic.c[i] += added.c[i];
    }
  }
  return result;
}

}  // namespace armature
