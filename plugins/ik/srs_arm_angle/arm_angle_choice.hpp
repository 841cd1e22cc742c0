// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <numbers>
#include <optional>

#include "posture_cost.hpp"

namespace armature {

/// The arm angle that an objective likes best, of the arms of one elbow. Looks at 48 places around
/// the turn, at three at least of every span, and where a shoulder or wrist is next to in line and
/// its outer joints therefore sweep through half a turn, at as many more as that takes; at a span's
/// end where it goes down to it. Wherever the slope turns from falling to rising between two
/// neighbours, the minimum is found to 1e-9 rad, unless their tangents leave it no room below what
/// is known. No allocation.
class ArmAngleChoice {
 public:
  /// `wanted`: what continuity keeps to, and what decides among equals [rad]; `last`: the arm angle
  /// that is remembered, if any.
  ArmAngleChoice(const SrsArm& arm, const ArmCircle& circle, Objective objective, double wanted,
                 std::optional<double> last);

  /// Of one branch; `spans` is not empty.
  double best(const Flips& flips, const Spans& spans);

 private:
  static constexpr int kRegular = 48, kMost = 256;
  static constexpr double kStep = 2 * std::numbers::pi / kRegular;

  struct Node {
    double at;
    Level level;
  };
  void add_places(const ArmBall& ball);
  void add_place(double at) {
    if (places_ < kMost) place_[static_cast<std::size_t>(places_++)] = wrap_angle(at);
  }
  double from_last(double arm_angle) const { return last_ ? wrap_angle(arm_angle - *last_) : 0; }
  Node node_at(double arm_angle, const Flips& flips) const;
  /// The same at place `i`, whose shoulder and wrist all branches share.
  Node place(std::size_t i, const Flips& flips);
  void look_along(const Span& span, const Flips& flips, Node& best);
  void look_into(const Node& left, const Node& right, const Flips& flips, Node& best) const;
  static bool may_fall_below(double least, const Node& left, const Node& right);
  Node minimum_between(Node left, Node right, const Flips& flips) const;

  const SrsArm& arm_;
  const ArmCircle& circle_;
  Objective objective_;
  double wanted_;
  std::optional<double> last_;
  std::array<double, kMost> place_;  // [rad], rising
  int places_ = 0;
  std::array<PostureCost, kMost> cost_;
  std::array<bool, kMost> known_{};
};

/// The angle of `spans`, which is not empty, that is nearest to `wanted`, the short way round.
double nearest_in(const Spans& spans, double wanted);

}  // namespace armature
