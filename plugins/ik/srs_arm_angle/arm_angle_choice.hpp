// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <limits>
#include <optional>

#include "arm_kernel.hpp"
#include "feasible_angles.hpp"
#include "stretches.hpp"

namespace armature {

/// The arm angles that an objective likes best, one for each branch. Looks, in single precision, at
/// regular places around the turn, at three at least of every span, and where a shoulder or wrist
/// is next to in line and its outer joints therefore sweep through half a turn, at as many more as
/// that takes; at a span's end where it goes down to it. Wherever two neighbours have a minimum
/// between them it is found in double precision to 1e-8 rad, unless their tangents leave it no room
/// below what is known. Answers once. No allocation; less than 256 KiB, for the stack.
class ArmAngleChoice {
 public:
  /// The arm angle that is remembered, or the seed's, is what continuity keeps to, and what decides
  /// among equals.
  ArmAngleChoice(const ArmNumbers& numbers, const SrsGoal& goal, const SrsKernel& kernel,
                 const Aim& aim, const JointVector& seed)
      : numbers_{numbers}, goal_{goal}, kernel_{kernel}, aim_{aim}, seed_{seed} {
    if (aim.remembers) wanted_ = aim.last;
  }

  ArmAngleChoice(const ArmAngleChoice&) = delete;
  ArmAngleChoice& operator=(const ArmAngleChoice&) = delete;

  /// By branch, from its spans in arm angles of elbow 0; what is wanted where it has none.
  void choose(const std::array<Spans, 8>& spans, std::array<double, 8>& arm_angle);

 private:
  /// An arm angle of a branch [rad] and what it costs.
  struct Node {
    double at, value, slope;
  };
  static constexpr Node kNoNode{std::numeric_limits<double>::quiet_NaN(), 0, 0};
  /// An end of a stretch, or a place within it where a ball is in line: its turns are shared out
  /// there, so that it may cost less than all around it.
  struct End {
    enum class Kind { lower, upper, in_line };
    const Stretch* stretch;
    Kind kind;
    Node node;
  };
  /// Between two nodes, or a little beyond them; `outer` is another one on either side, if any.
  struct Valley {
    std::size_t branch;
    Node left, right, outer;
    double lower, upper;
    double lowest() const { return std::min(left.value, right.value); }
  };
  struct Best {
    double at, value;
  };
  static constexpr std::size_t kEnds = 6 * Stretches::kMax, kValleys = 1024;

  void find_best(std::array<Best, 8>& best);
  double has_subscribers();
  void add_ends(const Stretch& stretch);
  void add_end(const Stretch& stretch, End::Kind kind, double at);
  void add_places_in_line(const Stretch& stretch);
  void set_costs_of_ends();
  Node node_of(std::size_t branch, int place) const;
  void add_valley(const Stretch& stretch, const Node& left, const Node& right, const Node& outer);
  Node outer_node(const Stretch& stretch, int place, bool left_is_nearer) const;
  void look_at_end(const End& end, Best& best);
  float list_valleys(const Stretch& stretch, float least);
  void look_along(const Stretch* first, const Stretch* end, Best& best);
  void go_down(std::array<Best, 8>& best);
  void go_down_chosen(std::array<Best, 8>& best);
  void consider(const Best& another, Best& best);
  double nearest_to_wanted(std::size_t branch, const Spans& spans);

  const ArmNumbers& numbers_;
  const SrsGoal& goal_;
  const SrsKernel& kernel_;
  const Aim& aim_;
  const JointVector& seed_;
  std::optional<double> wanted_;  // the seed's only when it is asked for
  CostTable table_;
  Stretches stretches_{table_};
  std::array<End, kEnds> end_;  // in the order of the stretches
  std::size_t ends_ = 0, looked_at_ = 0;
  struct Listed {
    const Stretch* stretch;
    int place;
  };
  std::array<Listed, CostTable::kMax> listed_;  // valleys of one branch in the table
  std::size_t count_listed_ = 0;
  std::array<Valley, kValleys> valley_;
  std::size_t valleys_ = 0;
  std::array<std::size_t, kValleys> choice_, rest_;  // of valley_
  std::size_t chosen_ = 0;
};

/// The angle of `spans`, which is not empty, that is nearest to `wanted`, the short way round.
double nearest_in(const Spans& spans, double wanted);

}  // namespace armature
