// SPDX-License-Identifier: Apache-2.0
// What tests measure on an orientation curve, by looking at its samples only.
#pragma once

#include <algorithm>
#include <cmath>
#include <random>
#include <vector>

#include "armature/robot/orientations/orientation_curve.hpp"

namespace armature::testing {

inline double turn_between(const Eigen::Quaterniond& a, const Eigen::Quaterniond& b) {
  const Eigen::Quaterniond a_R_b = a.conjugate() * b;
  return 2 * std::atan2(a_R_b.vec().norm(), std::abs(a_R_b.w()));
}

/// Parameters from end to end, every piece in `parts`.
inline std::vector<double> parameters_along(const OrientationCurve& curve, int parts) {
  std::vector<double> u, ends = curve.piece_starts();
  ends.push_back(curve.key_parameters().back());
  for (std::size_t i = 1; i < ends.size(); ++i) {
    for (int k = 0; k < parts; ++k) u.push_back(std::lerp(ends[i - 1], ends[i], double(k) / parts));
  }
  u.push_back(ends.back());
  return u;
}

/// [rad] the sum of the turns from sample to sample.
inline double total_rotation(const OrientationCurve& curve, int parts = 2000) {
  double total = 0;
  Eigen::Quaterniond last = curve.at(curve.key_parameters().front()).rotation;
  for (const double u : parameters_along(curve, parts)) {
    const Eigen::Quaterniond next = curve.at(u).rotation;
    total += turn_between(last, next);
    last = next;
  }
  return total;
}

/// Largest norms of angular velocity and acceleration on the curve.
struct OrientationPeaks {
  double velocity = 0, acceleration = 0;
};
inline OrientationPeaks peaks_of(const OrientationCurve& curve, int parts = 2000) {
  OrientationPeaks peaks;
  for (const double u : parameters_along(curve, parts)) {
    const OrientationState state = curve.at(u);
    peaks.velocity = std::max(peaks.velocity, state.velocity.norm());
    peaks.acceleration = std::max(peaks.acceleration, state.acceleration.norm());
  }
  return peaks;
}

/// By how much rotation, angular velocity and acceleration differ `eps` before and behind `u`.
struct Jump {
  double rotation, velocity, acceleration;
};
inline Jump jump_at(const OrientationCurve& curve, double u, double eps) {
  const OrientationState before = curve.at(u - eps), behind = curve.at(u + eps);
  return {turn_between(before.rotation, behind.rotation),
          (behind.velocity - before.velocity).norm(),
          (behind.acceleration - before.acceleration).norm()};
}
/// The largest of each where pieces meet.
inline Jump largest_jump(const OrientationCurve& curve, double eps) {
  Jump largest{};
  const auto& starts = curve.piece_starts();
  for (std::size_t i = 1; i < starts.size(); ++i) {
    const Jump jump = jump_at(curve, starts[i], eps);
    largest.rotation = std::max(largest.rotation, jump.rotation);
    largest.velocity = std::max(largest.velocity, jump.velocity);
    largest.acceleration = std::max(largest.acceleration, jump.acceleration);
  }
  return largest;
}

/// Uniform over all rotations (Haar).
inline std::vector<Eigen::Quaterniond> random_keys(std::mt19937_64& random, std::size_t count) {
  std::normal_distribution<double> normal;
  std::vector<Eigen::Quaterniond> keys(count);
  for (auto& key : keys) {
    for (double& part : key.coeffs()) part = normal(random);
    key.normalize();
  }
  return keys;
}

}  // namespace armature::testing
