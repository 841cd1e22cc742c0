// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace armature::test {

/// The commanded reference at an instant, independent joints.
struct ReferenceSample {
  std::int64_t ns = 0;
  Eigen::VectorXd q, v, a;
};

struct ReferenceLimits {
  double period_s = 0.001;
  double velocity = 0, acceleration = 0, jerk = 0;
};

/// Where the recorded reference jumps, leaves its limits, or has a hole; none when it is smooth.
///
/// A motion whose acceleration is continuous and whose jerk stays within J moves between two
/// samples at the distance h by
///     |a1 - a0| <= J h,   |v1 - v0 - a0 h| <= J h^2/2,   |q1 - q0 - v0 h - a0 h^2/2| <= J h^3/6,
/// so whatever goes beyond is a jump.
std::optional<std::string> reference_defect(const std::vector<ReferenceSample>& reference,
                                            const ReferenceLimits& limits);

}  // namespace armature::test
