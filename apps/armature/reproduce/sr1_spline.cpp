// SPDX-License-Identifier: Apache-2.0
// SR-1, cubic splines through joint knots: with two extra knots, which make the accelerations at
// both ends zero, and the clamped spline without them.
#include <Eigen/LU>
#include <string>
#include <vector>

#include "armature/kinds/trajectory/trajectory_planner.hpp"
#include "reproduce/plugins.hpp"
#include "reproduce/sr1_parts.hpp"

namespace armature::reproduce::sr1 {
namespace {

struct Knots {
  explicit Knots(const Numbers& numbers)
      : q{numbers["knots"].numbers()}, t{Eigen::VectorXd::Zero(q.size())} {
    const Eigen::VectorXd intervals = numbers["intervals_s"].numbers();
    for (Eigen::Index i = 0; i < intervals.size(); ++i) t[i + 1] = t[i] + intervals[i];
  }
  Eigen::VectorXd q, t;
  double duration_s() const { return t[t.size() - 1]; }
  double interval(Eigen::Index i) const { return t[i + 1] - t[i]; }
};

/// trajectory/cubic_spline through the knots. The plugin chooses the knots' times itself: those of
/// the slowest joint at full speed, or those of a quintic law along s. A second joint, slower than
/// the first and as far at each knot as its time, makes the former the paper's; s makes the latter
/// the paper's.
Trajectory with_extra_knots(const Knots& knots) {
  JointSegment segment{.s = {}, .q = {}, .stop_at_end = true, .duration_s = knots.duration_s()};
  for (Eigen::Index i = 0; i < knots.q.size(); ++i) {
    const double x = knots.t[i] / knots.duration_s();
    segment.s.push_back(x * x * x * (10 + x * (-15 + x * 6)));
    segment.q.push_back(Eigen::Vector2d{knots.q[i], knots.t[i]});
  }
  const JointVector zero = JointVector::Zero(2);
  Plugins plugins;
  return plugins.get<TrajectoryPlanner>("trajectory/cubic_spline", "")
      .plan({.goal_id = 1,
             .start = {},
             .from = {segment.q.front(), zero, zero},
             .segments = {segment},
             .max_velocity = Eigen::Vector2d{1e6, 1e3},
             .max_acceleration = Eigen::Vector2d{1e6, 1e6}})
      .value();
}

/// The cubic spline with zero velocity at both ends. Its accelerations there cannot be chosen.
Trajectory clamped(const Knots& knots) {
  const Eigen::Index n = knots.q.size();
  const auto slope = [&](Eigen::Index i) {
    return (knots.q[i + 1] - knots.q[i]) / knots.interval(i);
  };
  Eigen::MatrixXd rows = Eigen::MatrixXd::Zero(n, n);  // the slopes left and right are equal
  Eigen::VectorXd right = Eigen::VectorXd::Zero(n);
  for (Eigen::Index i = 0; i + 1 < n; ++i) {
    const double h = knots.interval(i);
    rows(i, i) += 2 * h;
    rows(i + 1, i + 1) += 2 * h;
    rows(i, i + 1) = rows(i + 1, i) = h;
    right[i] += 6 * slope(i);
    right[i + 1] -= 6 * slope(i);
  }
  const Eigen::VectorXd m = rows.partialPivLu().solve(right);  // accelerations
  Trajectory spline{.goal_id = 1, .dof = 1, .start = {}, .knots = {0}, .pieces = {}};
  for (Eigen::Index i = 0; i + 1 < n; ++i) {
    const double h = knots.interval(i);
    spline.knots.push_back(knots.t[i + 1]);
    spline.pieces.push_back({{knots.q[i], slope(i) - h / 6 * (2 * m[i] + m[i + 1]), m[i] / 2,
                              (m[i + 1] - m[i]) / (6 * h), 0, 0}});
  }
  return spline;
}

/// Position, velocity and acceleration of the first joint.
Eigen::Vector3d state_at(const Trajectory& spline, double t) {
  const JointState state = spline.at(spline.start + seconds(t));
  return {state.q[0], state.v[0], state.a[0]};
}

void add_ends(const std::string& name, const Trajectory& spline, Results& results) {
  const Eigen::Vector3d first = state_at(spline, 0), last = state_at(spline, spline.duration_s());
  results.value("spline_ends", name + ": first velocity", first[1]);
  results.value("spline_ends", name + ": last velocity", last[1]);
  results.value("spline_ends", name + ": first acceleration", first[2]);
  results.value("spline_ends", name + ": last acceleration", last[2]);
}

void add_curves_of(const std::string& name, const Trajectory& spline, Results::Look look,
                   Results& results) {
  constexpr int kSteps = 470;  // of 10 ms, which meet the knots
  std::vector<double> time, values[3];
  for (int n = 0; n <= kSteps; ++n) {
    const double t = spline.duration_s() * n / kSteps;
    const Eigen::Vector3d state = state_at(spline, t);
    time.push_back(t);
    for (int i = 0; i < 3; ++i) values[i].push_back(state[i]);
  }
  for (std::size_t i = 0; i < 3; ++i) results.curve("splines", i, name, time, values[i], look);
}

/// All knots of a spline, and tenths of it.
void add_points(const Trajectory& spline, Results& results) {
  constexpr int kSteps = 10;
  for (std::size_t i = 0; i < spline.knots.size(); ++i) {
    const std::string row = "knot " + std::to_string(i + 1);
    const Eigen::Vector3d state = state_at(spline, spline.knots[i]);
    results.value("spline_knots", row + ": time", spline.knots[i]);
    results.value("spline_knots", row + ": position", state[0]);
    results.value("spline_knots", row + ": acceleration", state[2]);
  }
  for (int n = 1; n < kSteps; ++n) {
    const std::string row = "sample " + std::to_string(n);
    const Eigen::Vector3d state = state_at(spline, spline.duration_s() * n / kSteps);
    results.value("spline_samples", row + ": position", state[0]);
    results.value("spline_samples", row + ": velocity", state[1]);
    results.value("spline_samples", row + ": acceleration", state[2]);
  }
}

}  // namespace

void add_splines(const Numbers& numbers, Results& results) {
  const Knots knots{numbers["spline"]};
  const Trajectory ours = with_extra_knots(knots), plain = clamped(knots);
  add_ends("two extra knots", ours, results);
  add_ends("clamped", plain, results);
  add_points(ours, results);
  add_curves_of("trajectory/cubic_spline, two extra knots", ours, Results::Look::line, results);
  add_curves_of("clamped, no extra knots", plain, Results::Look::dashed, results);
  results.curve("splines", 0, "knots", {knots.t.begin(), knots.t.end()},
                {knots.q.begin(), knots.q.end()}, Results::Look::dots);
}

}  // namespace armature::reproduce::sr1
