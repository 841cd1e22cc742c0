// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <optional>

#include "feasible_angles.hpp"

namespace armature {

/// The arm angles that an objective likes best, one for each branch. Looks at regular places around
/// the turn, at all where a limit is reached, and where a shoulder or wrist is next to in line and
/// its outer joints therefore sweep through half a turn, at as many more as that takes. Wherever
/// two neighbours have a minimum between them it is found to 1e-8 rad, unless their tangents leave
/// it no room below what is known. Answers once. No allocation; less than 256 KiB, for the stack.
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

  /// By branch, each at an arm angle of its own; what is wanted where it has none.
  void choose(const FeasibleAngles& feasible, std::array<double, 8>& arm_angle);

 private:
  /// In an arm angle of elbow 0.
  struct Best {
    double at, value;
  };
  static constexpr std::size_t kValleys = 512;

  void set_places(const FeasibleAngles& feasible);
  void look_along(std::size_t branch, const FeasibleAngles& feasible);
  void look_along_run(std::size_t branch, int first, int last);
  void go_down();
  void consider(std::size_t branch, const Node& node);
  double wanted();
  double nearest_to_wanted(const Spans& spans);

  const ArmNumbers& numbers_;
  const SrsGoal& goal_;
  const SrsKernel& kernel_;
  const Aim& aim_;
  const JointVector& seed_;
  std::optional<double> wanted_;  // the seed's only when it is asked for
  std::array<Best, 8> best_;
  CostTable table_;
  std::array<int, KeptLimits::kMax> place_of_event_;
  std::array<Valley, kValleys> valley_;
  std::size_t valleys_ = 0;
};

}  // namespace armature
