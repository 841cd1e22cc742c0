// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>

#include "srs_kernel.hpp"

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
  /// One that begins where the last span ends, or later: where they touch both are one.
  void add(const Span& another);
};

/// Where the branches of a goal keep their limits: the ends are roots of a sin x + b cos x + c = 0,
/// one for each limit (Shimizu et al. 2008), and between two neighbouring roots one place tells
/// all. Where joints come in line turns are shared out as `arms_at` does. Real-time safe.
class FeasibleAngles {
 public:
  FeasibleAngles(const ArmNumbers& numbers, const SrsGoal& goal, const SrsKernel& kernel);

  /// Of a branch (of kBranches), in its own arm angles.
  Spans of(std::size_t branch) const;

  /// Where something may change, rising from -pi to pi, in arm angles of elbow 0.
  double event(std::size_t i) const { return event_[i]; }
  /// From one event to another, both included.
  struct Run {
    std::size_t first, last;
  };
  /// A bit for each event and for what is between it and the next; they are 0 when all runs of the
  /// branch are taken.
  std::uint64_t bits(std::size_t branch) const { return bits_[branch]; }
  static Run take_run(std::uint64_t& bits);

 private:
  void set_events(const ArmNumbers& numbers, const SrsGoal& goal, const SrsKernel& kernel);
  void add_events_in_line(const SrsArm& arm, const SrsGoal& goal, bool wrist);
  void set_kept_in_line(const ArmNumbers& numbers, const SrsGoal& goal, const SrsKernel& kernel,
                        std::size_t ball, KeptLimits& kept) const;

  std::array<double, KeptLimits::kMax> event_, middle_;  // and the middles between
  std::size_t count_ = 0;
  std::array<std::uint64_t, 8> bits_{};
};

}  // namespace armature
