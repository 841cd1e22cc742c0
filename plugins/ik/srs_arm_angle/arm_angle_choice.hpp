// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>

#include "arm_kernel.hpp"
#include "feasible_angles.hpp"

namespace armature {

/// The arm angles that an objective likes best, one for each branch. Looks at regular places around
/// the turn, at three at least of every span, and where a shoulder or wrist is next to in line and
/// its outer joints therefore sweep through half a turn, at as many more as that takes; at a span's
/// end where it goes down to it. Wherever two neighbours have a minimum between them it is found to
/// 1e-8 rad, unless their tangents leave it no room below what is known. No allocation.
class ArmAngleChoice {
 public:
  /// `wanted`: what continuity keeps to, and what decides among equals [rad].
  ArmAngleChoice(const ArmNumbers& numbers, const SrsGoal& goal, const SrsKernel& kernel,
                 const Aim& aim, double wanted)
      : numbers_{numbers}, goal_{goal}, kernel_{kernel}, aim_{aim}, wanted_{wanted} {}

  /// By branch; `wanted` where it has no span.
  void choose(const std::array<Spans, 8>& spans, std::array<double, 8>& arm_angle);

 private:
  /// A place of one branch: arm angle, cost, slope.
  struct Node {
    double at, value, slope;
  };
  /// A span and where it is in the table: places first, ..., end - 1, which begin anew at `count`.
  /// One with fewer than kFew has `inner_count` nodes of its own. Its ends are nodes where it goes
  /// down to them, otherwise they are kNone.
  struct Stretch {
    Span span;
    std::size_t branch;
    int first, end;
    double shift;  // from a place of elbow 0 to the arm angle of the branch
    std::size_t inner, inner_count, lower, upper;
  };
  struct Valley {
    std::size_t branch;
    Node left, right;
  };
  static constexpr int kFew = 2;
  static constexpr std::size_t kInner = 3, kNone = static_cast<std::size_t>(-1);
  static constexpr std::size_t kStretches = 8 * Spans::kCapacity;
  static constexpr std::size_t kNodes = kStretches * (kInner + 2);

  void set_stretches(const std::array<Spans, 8>& spans);
  void add_stretch(std::size_t branch, const Span& span);
  std::size_t add_node(std::size_t branch, double at);
  void add_ends(Stretch& stretch);
  void set_costs_of_nodes(std::size_t from);
  Node node_of(std::size_t node) const { return {at_[node], value_[node], slope_[node]}; }
  Node node_of(const Stretch& stretch, int place) const;
  Node first_of(const Stretch& stretch) const;
  Node last_of(const Stretch& stretch) const;
  void consider(const Node& node, Node& best) const;
  void look_between(std::size_t branch, const Node& left, const Node& right, Node& best);
  void look_along(const Stretch& stretch, Node& best);
  void keep_promising(std::size_t from, double least);
  void go_down(std::array<Node, 8>& best);

  const ArmNumbers& numbers_;
  const SrsGoal& goal_;
  const SrsKernel& kernel_;
  const Aim& aim_;
  double wanted_;
  CostTable table_;
  std::array<Stretch, kStretches> stretch_;
  std::size_t stretches_ = 0;
  std::array<double, kNodes + 3> at_, value_, slope_;
  std::array<int, kNodes + 3> branch_of_node_;
  std::size_t nodes_ = 0;
  std::array<Valley, kNodes + CostTable::kMost> valley_;
  std::size_t valleys_ = 0;
};

/// The angle of `spans`, which is not empty, that is nearest to `wanted`, the short way round.
double nearest_in(const Spans& spans, double wanted);

}  // namespace armature
