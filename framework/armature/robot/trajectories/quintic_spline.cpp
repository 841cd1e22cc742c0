// SPDX-License-Identifier: Apache-2.0
#include "armature/robot/trajectories/quintic_spline.hpp"

#include <Eigen/LU>
#include <stdexcept>

namespace armature {
namespace {

using Block = Eigen::Matrix2d;
/// Velocities (first row) and accelerations (second row) of all joints at a knot.
using KnotRates = Eigen::Matrix<double, 2, Eigen::Dynamic, 0, 2, kMaxJoints>;

// The C4 spline is the interpolant with the least integral of jerk^2. Setting that integral's
// derivatives by the velocity and the acceleration at a knot to zero says that snap and jerk are
// continuous there; the system is symmetric and positive definite, so that elimination needs no
// pivoting. Of a piece of length h from knot 0 to knot 1:
//   block_11 = [192/h^3, -36/h^2; -36/h^2, 9/h], block_00 the same with +36,
//   block_01 = [168/h^3, -24/h^2;  24/h^2, -3/h].
Block diagonal_block(double h, double side) {
  const double h2 = h * h;
  Block block;
  block << 192 / (h2 * h), side * 36 / h2, side * 36 / h2, 9 / h;
  return block;
}

Block next_block(double h) {
  const double h2 = h * h;
  Block block;
  block << 168 / (h2 * h), -24 / h2, 24 / h2, -3 / h;
  return block;
}

KnotRates rates(const JointState& state) {
  KnotRates result(2, state.q.size());
  result.row(0) = state.v.transpose();
  result.row(1) = state.a.transpose();
  return result;
}

/// What a piece contributes to the right side at the knot before (+1) or behind it (-1).
KnotRates pull(const JointVector& displacement, double h, double side) {
  KnotRates result(2, displacement.size());
  const double h3 = h * h * h;
  result.row(0) = 360 / (h3 * h) * displacement.transpose();
  result.row(1) = side * 60 / h3 * displacement.transpose();
  return result;
}

/// Velocities and accelerations at all knots: forward elimination, then back substitution.
std::vector<KnotRates> solve_rates(std::span<const double> knots,
                                   std::span<const JointVector> points, const JointState& first,
                                   const JointState& last) {
  const std::size_t n = knots.size();
  std::vector<KnotRates> x(n);
  std::vector<Block> upper(n);  // D_i^-1 B_i of the eliminated rows
  x.front() = rates(first);
  x.back() = rates(last);
  for (std::size_t i = 1; i + 1 < n; ++i) {
    const double before = knots[i] - knots[i - 1], behind = knots[i + 1] - knots[i];
    Block d = diagonal_block(before, -1) + diagonal_block(behind, 1);
    KnotRates right =
        pull(points[i] - points[i - 1], before, -1) + pull(points[i + 1] - points[i], behind, 1);
    const Block to_previous = next_block(before).transpose();
    right -= to_previous * x[i - 1];
    if (i > 1) d -= to_previous * upper[i - 1];
    const Block inverse = d.inverse();
    upper[i] = inverse * next_block(behind);
    x[i] = inverse * right;
  }
  for (std::size_t i = n - 1; i-- > 1;) x[i] -= upper[i] * x[i + 1];
  return x;
}

}  // namespace

std::vector<Quintic> quintic_spline(std::span<const double> knots,
                                    std::span<const JointVector> points, const JointState& first,
                                    const JointState& last) {
  if (knots.size() < 2 || points.size() != knots.size())
    throw std::invalid_argument("a spline needs two or more knots and a point for each");
  for (std::size_t i = 1; i < knots.size(); ++i)
    if (!(knots[i] > knots[i - 1])) throw std::invalid_argument("a spline's knots must ascend");

  const std::vector<KnotRates> x = solve_rates(knots, points, first, last);
  std::vector<Quintic> pieces;
  pieces.reserve((knots.size() - 1) * static_cast<std::size_t>(points.front().size()));
  for (std::size_t i = 1; i < knots.size(); ++i)
    for (Eigen::Index j = 0; j < points[i].size(); ++j)
      pieces.push_back(Quintic::between({points[i - 1][j], x[i - 1](0, j), x[i - 1](1, j)},
                                        {points[i][j], x[i](0, j), x[i](1, j)},
                                        knots[i] - knots[i - 1]));
  return pieces;
}

}  // namespace armature
