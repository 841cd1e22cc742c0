// SPDX-License-Identifier: Apache-2.0
#include "armature/robot/trajectories/cubic_spline.hpp"

#include <stdexcept>

namespace armature {
namespace {

/// The spline's knots, and what is known of its points: q = known + share M, with M the
/// acceleration there. Only the two knots that were added have a share, which the ends' velocities
/// leave them.
struct Knots {
  std::vector<double> at;
  std::vector<JointVector> known;
  std::vector<double> share;

  double interval(std::size_t i) const { return at[i + 1] - at[i]; }
};

Knots with_virtual_knots(std::span<const double> knots, std::span<const JointVector> points,
                         const JointState& first, const JointState& last) {
  const std::size_t n = knots.size();
  const double part = n == 2 ? 1.0 / 3 : 0.5;
  Knots all;
  all.at.assign(knots.begin(), knots.end());
  all.known.assign(points.begin(), points.end());
  all.at.insert(all.at.begin() + 1, knots[0] + part * (knots[1] - knots[0]));
  all.at.insert(all.at.end() - 1, knots[n - 1] - part * (knots[n - 1] - knots[n - 2]));
  const double h = all.interval(0), g = all.interval(all.at.size() - 2);
  all.known.insert(all.known.begin() + 1, points[0] + h * first.v + h * h / 3 * first.a);
  all.known.insert(all.known.end() - 1, points[n - 1] - g * last.v + g * g / 3 * last.a);
  all.share.assign(all.at.size(), 0);
  all.share[1] = h * h / 6;
  all.share[all.at.size() - 2] = g * g / 6;
  return all;
}

/// Accelerations at all knots: the slopes left and right of each are equal.
std::vector<JointVector> accelerations(const Knots& k, const JointState& first,
                                       const JointState& last) {
  const std::size_t n = k.at.size();
  std::vector<JointVector> m(n);
  std::vector<double> upper(n, 0);  // of the eliminated rows
  m.front() = first.a;
  m.back() = last.a;
  for (std::size_t i = 1; i + 1 < n; ++i) {
    const double h = k.interval(i - 1), g = k.interval(i);
    const double to_previous = h - 6 * k.share[i - 1] / h, to_next = g - 6 * k.share[i + 1] / g;
    double diagonal = 2 * (h + g) + 6 * k.share[i] * (1 / h + 1 / g);
    JointVector right = 6 / g * (k.known[i + 1] - k.known[i]) -
                        6 / h * (k.known[i] - k.known[i - 1]) - to_previous * m[i - 1];
    diagonal -= to_previous * upper[i - 1];
    upper[i] = to_next / diagonal;
    m[i] = right / diagonal;
  }
  for (std::size_t i = n - 1; i-- > 1;) m[i] -= upper[i] * m[i + 1];
  return m;
}

}  // namespace

KnottedPieces cubic_spline(std::span<const double> knots, std::span<const JointVector> points,
                           const JointState& first, const JointState& last) {
  if (knots.size() < 2 || points.size() != knots.size())
    throw std::invalid_argument("a spline needs two or more knots and a point for each");
  for (std::size_t i = 1; i < knots.size(); ++i)
    if (!(knots[i] > knots[i - 1])) throw std::invalid_argument("a spline's knots must ascend");

  Knots k = with_virtual_knots(knots, points, first, last);
  const std::vector<JointVector> m = accelerations(k, first, last);
  std::vector<JointVector> q = k.known;
  for (std::size_t i = 0; i < q.size(); ++i) q[i] += k.share[i] * m[i];

  KnottedPieces spline{std::move(k.at), {}};
  spline.pieces.reserve((q.size() - 1) * static_cast<std::size_t>(q.front().size()));
  for (std::size_t i = 0; i + 1 < q.size(); ++i) {
    const double h = spline.knots[i + 1] - spline.knots[i];
    const JointVector slope = (q[i + 1] - q[i]) / h - h / 6 * (2 * m[i] + m[i + 1]);
    const JointVector jerk = (m[i + 1] - m[i]) / h;
    for (Eigen::Index j = 0; j < slope.size(); ++j) {
      spline.pieces.push_back({{q[i][j], slope[j], m[i][j] / 2, jerk[j] / 6, 0, 0}});
    }
  }
  return spline;
}

}  // namespace armature
