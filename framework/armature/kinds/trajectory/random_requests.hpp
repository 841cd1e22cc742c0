// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <random>

#include "armature/kinds/trajectory/trajectory_planner.hpp"

namespace armature ARMATURE_EXPORT {

/// Requests by chance for three joints.
class RandomRequests {
 public:
  static constexpr std::uint64_t kSeed = 11;
  static constexpr int kDof = 3;

  JointVector vector(double size) {
    JointVector v(kDof);
    for (double& x : v) x = size * normal_(random_);
    return v;
  }
  /// A smooth random curve from `q` with `n` parts; one part is a straight line.
  JointSegment curve_from(const JointVector& q, int n, double size) {
    const JointVector line = vector(size), bow = vector(0.5 * size);
    JointSegment segment;
    for (int i = 0; i <= n; ++i) {
      const double s = static_cast<double>(i) / n;
      segment.s.push_back(s);
      segment.q.push_back(q + s * line + (n > 1 ? s * (1 - s) : 0) * bow);
    }
    return segment;
  }
  /// A request without segments whose start moves with about `start_speed`.
  TrajectoryRequest request(double start_speed) {
    TrajectoryRequest request;
    request.goal_id = 7;
    request.start = Time{5'000'000'000};
    request.from = {vector(1), vector(start_speed), vector(start_speed)};
    request.max_velocity = JointVector::Constant(kDof, 1.5);
    request.max_acceleration = JointVector::Constant(kDof, 4);
    return request;
  }

 private:
  std::mt19937_64 random_{kSeed};
  std::normal_distribution<double> normal_;
};

}  // namespace armature
