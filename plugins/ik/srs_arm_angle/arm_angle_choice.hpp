// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>

#include "arm_kernel.hpp"
#include "feasible_angles.hpp"

namespace armature {

/// The arm angles that an objective likes best, one for each branch. Looks, in single precision, at
/// regular places around the turn, at three at least of every span, and where a shoulder or wrist
/// is next to in line and its outer joints therefore sweep through half a turn, at as many more as
/// that takes; at a span's end where it goes down to it. Wherever two neighbours have a minimum
/// between them it is found in double precision to 1e-8 rad, unless their tangents leave it no room
/// below what is known. No allocation.
class ArmAngleChoice {
 public:
  /// `wanted`: what continuity keeps to, and what decides among equals [rad].
  ArmAngleChoice(const ArmNumbers& numbers, const SrsGoal& goal, const SrsKernel& kernel,
                 const Aim& aim, double wanted)
      : numbers_{numbers}, goal_{goal}, kernel_{kernel}, aim_{aim}, wanted_{wanted} {}

  /// By branch, from its spans in arm angles of elbow 0; `wanted` where it has none.
  void choose(const std::array<Spans, 8>& spans, std::array<double, 8>& arm_angle);

 private:
  /// An arm angle of a branch [rad] and what it costs.
  struct Node {
    double at, value, slope;
  };
  /// A span of a branch: its places in the table, but for ones at its ends, are first, ..., end
  /// - 1. Its ends are nodes where it goes down to them, otherwise kNone; of a point the lower one
  /// is.
  struct Stretch {
    Span span;
    std::size_t branch;
    int first, end;
    std::size_t lower, upper;
  };
  /// Between two nodes, or a little beyond them.
  struct Valley {
    std::size_t branch;
    Node left, right;
    double lower, upper;
  };
  struct Best {
    double at, value;
  };
  static constexpr int kFew = 2, kInner = 3;
  static constexpr std::size_t kNone = static_cast<std::size_t>(-1);
  static constexpr std::size_t kStretches = 8 * Spans::kCapacity;
  static constexpr std::size_t kNodes = 2 * kStretches, kValleys = 1024;

  void find_best(std::array<Best, 8>& best);
  void add_stretch(std::size_t branch, const Span& span);
  void add_ends(Stretch& stretch);
  std::size_t add_end(std::size_t branch, double at);
  void set_costs_of_ends();
  Node end_node(std::size_t end) const { return {at_[end], value_[end], slope_[end]}; }
  Node node_of(std::size_t branch, int place) const;
  void add_valley(const Stretch& stretch, const Node& left, const Node& right);
  void look_at_ends(const Stretch& stretch, Best& best);
  float list_valleys(const Stretch& stretch, float least);
  void look_along(const Stretch* first, const Stretch* end, Best& best);
  void go_down(std::array<Best, 8>& best);
  void consider(const Best& another, Best& best) const;
  double nearest_to_wanted(std::size_t branch, const Spans& spans) const;

  const ArmNumbers& numbers_;
  const SrsGoal& goal_;
  const SrsKernel& kernel_;
  const Aim& aim_;
  double wanted_;
  CostTable table_;
  std::array<Stretch, kStretches> stretch_;
  std::size_t stretches_ = 0;
  std::array<double, kNodes + 3> at_, value_, slope_;  // of the ends of stretches
  std::array<int, kNodes + 3> branch_of_end_;
  std::size_t ends_ = 0;
  struct Listed {
    const Stretch* stretch;
    int place;
  };
  std::array<Listed, CostTable::kMost> listed_;  // valleys of one branch in the table
  std::size_t count_listed_ = 0;
  std::array<Valley, kValleys> valley_;
  std::size_t valleys_ = 0;
};

/// The angle of `spans`, which is not empty, that is nearest to `wanted`, the short way round.
double nearest_in(const Spans& spans, double wanted);

}  // namespace armature
