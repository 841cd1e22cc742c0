// SPDX-License-Identifier: Apache-2.0
#include "armature/robot/orientations/curve_measures.hpp"

#include <algorithm>
#include <cmath>

namespace armature {
namespace {

/// The largest of each over all places where pieces meet, from as far as `eps_at` says.
template <class EpsAt>
OrientationJump largest(const OrientationCurve& curve, EpsAt eps_at) {
  OrientationJump largest;
  const auto& starts = curve.piece_starts();
  for (std::size_t i = 1; i < starts.size(); ++i) {
    const OrientationJump jump = jump_at(curve, starts[i], eps_at(i));
    largest.rotation = std::max(largest.rotation, jump.rotation);
    largest.velocity = std::max(largest.velocity, jump.velocity);
    largest.acceleration = std::max(largest.acceleration, jump.acceleration);
  }
  return largest;
}

}  // namespace

double turn_between(const Eigen::Quaterniond& a, const Eigen::Quaterniond& b) {
  const Eigen::Quaterniond a_R_b = a.conjugate() * b;
  return 2 * std::atan2(a_R_b.vec().norm(), std::abs(a_R_b.w()));
}

std::vector<double> parameters_along(const OrientationCurve& curve, int parts) {
  std::vector<double> u, ends = curve.piece_starts();
  ends.push_back(curve.key_parameters().back());
  for (std::size_t i = 1; i < ends.size(); ++i) {
    for (int k = 0; k < parts; ++k) {
      u.push_back(std::lerp(ends[i - 1], ends[i], static_cast<double>(k) / parts));
    }
  }
  u.push_back(ends.back());
  return u;
}

double total_rotation(const OrientationCurve& curve, int parts) {
  double total = 0;
  Eigen::Quaterniond last = curve.at(curve.key_parameters().front()).rotation;
  for (const double u : parameters_along(curve, parts)) {
    const Eigen::Quaterniond next = curve.at(u).rotation;
    total += turn_between(last, next);
    last = next;
  }
  return total;
}

OrientationPeaks peaks_of(const OrientationCurve& curve, int parts) {
  OrientationPeaks peaks;
  for (const double u : parameters_along(curve, parts)) {
    const OrientationState state = curve.at(u);
    peaks.velocity = std::max(peaks.velocity, state.velocity.norm());
    peaks.acceleration = std::max(peaks.acceleration, state.acceleration.norm());
  }
  return peaks;
}

OrientationJump jump_at(const OrientationCurve& curve, double u, double eps) {
  const OrientationState before = curve.at(u - eps), behind = curve.at(u + eps);
  return {turn_between(before.rotation, behind.rotation),
          (behind.velocity - before.velocity).norm(),
          (behind.acceleration - before.acceleration).norm()};
}

OrientationJump largest_jump(const OrientationCurve& curve, double eps) {
  return largest(curve, [eps](std::size_t) { return eps; });
}

OrientationJump largest_jump_beside(const OrientationCurve& curve, double part) {
  std::vector<double> ends = curve.piece_starts();
  ends.push_back(curve.key_parameters().back());
  return largest(curve, [&](std::size_t i) {
    return part * std::min(ends[i] - ends[i - 1], ends[i + 1] - ends[i]);
  });
}

}  // namespace armature
