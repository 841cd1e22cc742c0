// SPDX-License-Identifier: Apache-2.0
#include "armature/kinds/trajectory/joint_curve.hpp"

#include <algorithm>
#include <array>
#include <span>
#include <utility>

#include "armature/robot/trajectories/quintic_spline.hpp"

namespace armature {
namespace {

constexpr std::size_t kMaxNeighbours = 8;

/// Value and first two derivatives at `s[at]` of the polynomial through all given waypoints
/// (Newton's divided differences, then Horner for the value and both derivatives at once).
JointState polynomial_at(std::span<const double> s, std::span<const JointVector> q,
                         std::size_t at) {
  const std::size_t n = s.size();
  std::array<JointVector, kMaxNeighbours> difference;
  std::copy(q.begin(), q.end(), difference.begin());
  for (std::size_t order = 1; order < n; ++order) {
    for (std::size_t i = n - 1; i >= order; --i) {
      difference[i] = (difference[i] - difference[i - 1]) / (s[i] - s[i - order]);
    }
  }
  const JointVector zero = JointVector::Zero(q.front().size());
  JointState state{difference[n - 1], zero, zero};
  for (std::size_t i = n - 1; i-- > 0;) {
    const double h = s[at] - s[i];
    state.a = state.a * h + 2 * state.v;
    state.v = state.v * h + state.q;
    state.q = state.q * h + difference[i];
  }
  return state;
}

}  // namespace

JointCurve::JointCurve(std::vector<double> s, std::vector<JointVector> q)
    : s_{std::move(s)}, q_{std::move(q)} {
  const std::size_t near = std::min(kMaxNeighbours, s_.size());
  const std::span<const double> all_s{s_};
  const std::span<const JointVector> all_q{q_};
  pieces_ = quintic_spline(all_s, all_q, polynomial_at(all_s.first(near), all_q.first(near), 0),
                           polynomial_at(all_s.last(near), all_q.last(near), near - 1));
}

JointState JointCurve::at(double s) const {
  const auto next = std::upper_bound(s_.begin() + 1, s_.end() - 1, s);
  const auto piece = static_cast<std::size_t>(next - s_.begin()) - 1;
  const double t = s - s_[piece];
  const auto joints = static_cast<std::size_t>(dof());
  JointState state{JointVector(dof()), JointVector(dof()), JointVector(dof())};
  for (std::size_t j = 0; j < joints; ++j) {
    const Quintic& quintic = pieces_[piece * joints + j];
    const auto i = static_cast<Eigen::Index>(j);
    state.q[i] = quintic.position(t);
    state.v[i] = quintic.velocity(t);
    state.a[i] = quintic.acceleration(t);
  }
  return state;
}

}  // namespace armature
