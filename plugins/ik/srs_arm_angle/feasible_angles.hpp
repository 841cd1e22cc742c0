// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>

#include "srs_structure.hpp"

namespace armature::ik::srs_arm_angle {

/// Arm angles from `lower` to `upper` [rad], both included.
struct Span {
  double lower, upper;
};

/// Disjoint ones, rising, within [-pi, pi]. Never allocates.
struct Spans {
  // A joint has at most two arcs, so a shoulder or a wrist at most six; where its axes are
  // collinear, two points more. Both together, and the circle cut at pi: 17.
  static constexpr int kCapacity = 20;
  std::array<Span, kCapacity> span;
  int count = 0;

  const Span* begin() const { return span.data(); }
  const Span* end() const { return span.data() + count; }
  /// Adds a span, or makes the last one longer where that ends where `another` begins.
  void join(const Span& another);
};
using SpansByBranch = std::array<Spans, 8>;

/// Where the branches of a goal keep their limits, in arm angles of elbow 0: those of elbow 1 less
/// half a turn. The ends are roots of u sin x + v cos x + w = 0, one for each limit (Shimizu et al.
/// 2008), and between two neighbouring roots one arm angle tells all. Where axes are collinear
/// turns are shared out as in `solve`. Real-time safe.
void set_feasible_angles(const SrsArm& arm, const SrsGoal& goal, SpansByBranch& spans);

/// Half a turn on.
Spans half_turned(const Spans& spans);

}  // namespace armature::ik::srs_arm_angle
