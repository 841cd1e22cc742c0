// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>

#include "arm_posture.hpp"
#include "srs_joints.hpp"

namespace armature {

/// Which shoulder and which wrist: as found (0) or flipped (1).
struct Flips {
  std::size_t shoulder = 0, wrist = 0;
};

/// Arm angles from `lower` to `upper` [rad], both included.
struct Span {
  double lower = 0, upper = 0;
};

/// Disjoint ones, rising, within [-pi, pi]. Never allocates.
struct Spans {
  // A joint has at most two arcs, so a ball joint at most six; where it is in line, two points
  // more. Two ball joints together, and the circle cut at pi: 17.
  static constexpr int kCapacity = 20;
  std::array<Span, kCapacity> span;
  int count = 0;

  const Span* begin() const { return span.data(); }
  const Span* end() const { return span.data() + count; }
  void add(const Span& another) {
    if (count < kCapacity) span[static_cast<std::size_t>(count++)] = another;
  }
};

/// Where a shoulder or wrist keeps its limits, as it is found (0) and flipped (1): the ends are
/// roots of a sin x + b cos x + c = 0, one for each limit (Shimizu et al. 2008), and
/// between two neighbouring roots one place tells all. Real-time safe.
std::array<Spans, 2> feasible_spans(const SrsArm& arm, const ArmBall& ball);

/// Where shoulder and wrist of one branch both do. Spans that miss each other by rounding have the
/// points in common at which both keep their limits.
Spans common_spans(const SrsArm& arm, const ArmCircle& circle, const Flips& flips,
                   const Spans& shoulder, const Spans& wrist);

}  // namespace armature
