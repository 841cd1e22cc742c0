// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <optional>

#include "armature/robot/model/joint_vector.hpp"
#include "feasible_angles.hpp"

namespace armature::ik::srs_arm_angle {

/// The arm angles that an objective likes best, one for each branch. Looks at regular arm angles
/// around the turn, at three at least within every span, and where a shoulder or wrist is next to
/// collinear and its outer joints therefore sweep through half a turn, at as many more as that
/// takes; at a span's end where the cost goes down to it. Wherever two neighbours have a minimum
/// between them it is found to 1e-8 rad, unless their tangents leave it no room below what is
/// known. Answers once. No allocation; less than 256 KiB, for the stack.
class ArmAngleChoice {
 public:
  /// The arm angle that is remembered, or the seed's, is what continuity keeps to, and what decides
  /// among equals.
  ArmAngleChoice(const SrsArm& arm, const SrsGoal& goal, const Aim& aim, const JointVector& seed)
      : arm_{arm}, goal_{goal}, aim_{aim}, seed_{seed} {
    if (aim.remembers) wanted_ = aim.last;
  }
  ArmAngleChoice(const ArmAngleChoice&) = delete;
  ArmAngleChoice& operator=(const ArmAngleChoice&) = delete;

  /// By branch, from its spans; what is wanted where it has none.
  void choose(const SpansByBranch& spans, std::array<double, 8>& arm_angle);

 private:
  /// Nodes with a number in `nodes_` of what has still to be asked, or -1.
  struct Pending {
    Valley valley;
    int left, right;
  };
  struct Best {
    double at, value;
  };
  static constexpr int kMaxNodes = 640, kMaxValleys = 1024;

  double wanted();
  double nearest_to_wanted(int branch, const Spans& spans);
  Node table_node(int branch, int place) const;
  int place_from(double at) const;
  int add_node(int branch, double at, bool is_inner = false);
  void add_valley(const Node& left, const Node& right);
  void add_spans(int branch, const Spans& spans);
  void add_span(int branch, const Span& span);
  void add_narrow_span(int branch, const Span& span);
  void add_valleys_between(int branch, int first, int last);
  void add_collinear_places(int branch, const Span& span);
  void consider(const Node& node);
  void drop_hopeless_valleys();
  void find_best(const SpansByBranch& spans);

  const SrsArm& arm_;
  const SrsGoal& goal_;
  const Aim& aim_;
  const JointVector& seed_;
  std::optional<double> wanted_;  // the seed's only when it is asked for
  CostTable table_;
  std::array<Node, kMaxNodes> nodes_;
  std::array<bool, kMaxNodes> is_inner_;  // of a narrow span: a node only, no candidate
  int count_nodes_ = 0;
  std::array<Pending, kMaxNodes> pending_;
  int count_pending_ = 0;
  std::array<Valley, kMaxValleys> valleys_;
  int count_valleys_ = 0;
  std::array<Best, 8> best_;
};

/// The angle of `spans`, which is not empty, that is nearest to `wanted`, the short way round.
double nearest_in(const Spans& spans, double wanted);

/// The arm angles at which costs are looked at all round: regular ones, and more where a shoulder
/// or wrist comes next to collinear.
void set_places(const SrsGoal& goal, const Aim& aim, CostTable& table);

}  // namespace armature::ik::srs_arm_angle
