// SPDX-License-Identifier: Apache-2.0
// What arm angles cost and how that changes, of branches at once; see balls_body.hpp.
#pragma once

#include "motion_body.hpp"

namespace armature {
namespace {

/// A shoulder or wrist of elbow 0: what its joints are apart from half turns.
template <Which which, Case which_case>
class CostOfBall {
 public:
  [[gnu::always_inline]] CostOfBall(const ArmNumbers& numbers, const SrsGoal& goal,
                                    const Balls& balls, const LaneSinCos& arm_angle)
      : numbers_{numbers},
        moving_{moving_ball<which_case>(goal, balls, x_at<which>(goal, arm_angle))} {
    const Shifts shift = shifts_of<which>(goal);
    a_ = angle_of(moving_.angles.a) + shift.a - either<which>(numbers.turn[0].middle);
    b_ = angle_of(moving_.angles.b);
    c_ = angle_of(moving_.angles.c) + shift.c - either<which>(numbers.turn[2].middle);
  }

  const MovingBall<Lanes>& moving() const { return moving_; }
  /// Of the limits, with a and c half a turn on and b negated where asked for; in line both flips
  /// are one (turns_of), and elbow 1 has c half a turn on.
  Level<Lanes> limits(const Masks& a, const Masks& b, const Masks& c, const Masks& elbow) const {
    const Masks &free = moving_.angles.free, bound = ~free;
    if (which_case == Case::common || !any(free)) return turned(a, b, c);
    return turned(a & bound, b & bound, (c & bound) | (elbow & free));
  }

 private:
  Level<Lanes> turned(const Masks& a, const Masks& b, const Masks& c) const {
    const Motion<Lanes>& m = moving_.motion;
    const auto part = [&](int i, const Lanes& from_middle, const Rate<Lanes>& rate) {
      const Lanes weight = either<which>(numbers_.turn[i].weight);
      return weight * Level<Lanes>{near_zero(from_middle), rate.slope, rate.bend};
    };
    const Rate<Lanes> b_rate{b ? -m.b.slope : m.b.slope, b ? -m.b.bend : m.b.bend};
    const Lanes half = all(kPi), none = all(0);
    const LimitCosts<Lanes> cost =
        limit_costs(part(0, a_ + (a ? half : none), m.a),
                    part(1, (b ? -b_ : b_) - either<which>(numbers_.turn[1].middle), b_rate),
                    part(2, c_ + (c ? half : none), m.c));
    return cost.a + cost.b + cost.c;
  }

  const ArmNumbers& numbers_;
  MovingBall<Lanes> moving_;
  Lanes a_, b_, c_;
};

/// Branches, each at an arm angle of its own.
template <Case which_case>
class CostOfBranches {
 public:
  CostOfBranches(const ArmNumbers& numbers, const SrsGoal& goal, const Aim& aim, const int* branch)
      : numbers_{numbers},
        goal_{goal},
        aim_{aim},
        turns_{turns_of_branches(branch)},
        shoulders_{balls_of<Which::shoulder>(goal)},
        wrists_{balls_of<Which::wrist>(goal)} {}

  [[gnu::always_inline]] Level<Lanes> at(const Lanes& arm_angle) const {
    const LaneSinCos back = turned_back(arm_angle, turns_);
    const CostOfBall<Which::shoulder, which_case> shoulder{numbers_, goal_, shoulders_, back};
    const CostOfBall<Which::wrist, which_case> wrist{numbers_, goal_, wrists_, back};
    const auto limits = [&] {
      return shoulder.limits(turns_.shoulder_a, turns_.shoulder_a, turns_.shoulder_c,
                             turns_.elbow) +
             wrist.limits(turns_.wrist_a, turns_.wrist_c, turns_.wrist_c, turns_.elbow);
    };
    if (which_case == Case::common) return limits();
    const Level<Lanes> cost =
        shared_cost(aim_, shoulder.moving(), wrist.moving()) + way_cost(aim_, arm_angle);
    return aim_.objective == Objective::singularity ? cost : cost + limits();
  }

 private:
  const ArmNumbers& numbers_;
  const SrsGoal& goal_;
  const Aim& aim_;
  BranchTurns turns_;
  Balls shoulders_, wrists_;
};

void find_costs_at(const ArmNumbers& numbers, const SrsGoal& goal, const Aim& aim,
                   const EightPlaces& at, int count, double (&value)[8], double (&slope)[8]) {
  for (int i = 0; i < count; i += kLanes) {
    const Level<Lanes> cost =
        CostOfBranches<Case::any>{numbers, goal, aim, at.branch + i}.at(load(at.arm_angle + i));
    store(cost.value, value + i);
    store(cost.slope, slope + i);
  }
}

}  // namespace
}  // namespace armature
