// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>

#include "arm_kernel.hpp"
#include "branches.hpp"
#include "srs_joints.hpp"

namespace armature {

/// Arm angles from `lower` to `upper` [rad], both included.
struct Span {
  double lower, upper;
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

/// Where the branches of a goal keep their limits: the ends are roots of a sin x + b cos x + c = 0,
/// one for each limit (Shimizu et al. 2008), and between two neighbouring roots one place tells
/// all (SrsKernel::limits_kept). Where joints come in line turns are shared out as in turns_of.
/// Real-time safe.
class FeasibleAngles {
 public:
  FeasibleAngles(const ArmNumbers& numbers, const SrsGoal& goal, const SrsKernel& kernel);

  /// Where shoulder and wrist of a branch both do. Spans that miss each other by rounding have the
  /// points in common at which both keep their limits.
  Spans of(const Branch& branch) const;
  /// The same in arm angles of elbow 0: those of elbow 1 less half a turn.
  void of_elbow0(const Branch& branch, Spans& common) const;

 private:
  /// By ball, 0 the shoulder and 1 the wrist, elbow and flip; in arm angles of elbow 0.
  using Kept = std::array<std::array<std::array<Spans, 2>, 2>, 2>;
  ArmBall ball(std::size_t which, std::size_t elbow) const;
  std::array<bool, 2> keep_at(std::size_t which, std::size_t elbow, double arm_angle) const;
  bool in_line_everywhere(std::size_t which, std::size_t elbow) const;
  void add_points_in_line(std::size_t which, std::size_t elbow, LimitPieces& pieces) const;
  Spans spans_in_line(std::size_t which, std::size_t elbow) const;
  bool both_keep_at(const Branch& branch, double at) const;

  const SrsArm& arm_;
  const SrsGoal& goal_;
  std::array<bool, 2> elbow_within_limits_;
  Kept kept_;
};

}  // namespace armature
