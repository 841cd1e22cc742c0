// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <span>
#include <string_view>
#include <vector>

#include "armature/kinds/ik/ik.hpp"
#include "armature/laws/law.hpp"

namespace armature ARMATURE_EXPORT {

namespace ik_contract {
class Probe;
}

/// A solver made for a robot, and what it promises.
struct IkSubject {
  std::shared_ptr<const RobotModel> model;
  std::shared_ptr<const IkSolver> solver;
  bool closed_form = false;  // `all_branches`: finds every branch; else at least one
  int poses = 2000;          // random ones
  std::uint64_t seed = 20210612;
  bool any_seed = true;           // `any_seed`: reaches what can be reached, wherever the seed is
  bool any_seed_at_edges = true;  // the same at singular poses, limits and the rim: 99.5 %
  bool allocates = false;         // `allocates`: may allocate while it solves
  int edge_poses = 1000;          // of every set of edges
};

/// What a law needs of the program that it runs in.
struct IkLawTools {
  /// How often the calling thread has allocated; none: the program does not count.
  std::size_t (*allocations)() = nullptr;
  /// Told every question before it is asked: what was the last one, should the solver crash?
  std::function<void(const IkGoal&, const JointVector& seed)> before_solve;
};

/// A law that every `ik` plugin keeps, for any robot that it serves.
struct IkLaw {
  std::string_view name;  // "ForwardKinematicsOfEverySolutionIsTheGoal"
  std::string_view says;  // in short, for a table
  void (*check)(ik_contract::Probe&);
};

/// Every law, in the order in which they are best read.
std::span<const IkLaw> ik_laws();

/// Checks `law` with goals of the subject's robot; the same goals on every run. An exception out of
/// the solver breaks the law.
LawReport check_law(const IkLaw& law, const IkSubject& subject, const IkLawTools& tools = {});

}  // namespace armature

// The laws by name: LAW(TheSentence, the_function, "in short").
#define ARMATURE_IK_LAWS(LAW)                                                                    \
  LAW(ForwardKinematicsOfEverySolutionIsTheGoal, solutions_reach, "fk(ik(goal)) = goal")         \
  LAW(AGoalWithinLimitsIsReached, goals_are_reached, "what is within limits is reached")         \
  LAW(TheJointsThatMadeAGoalAreAmongItsSolutions, generator_is_found, "no branch is missing")    \
  LAW(FlagsAndLabelsTellTheTruth, flags_are_true, "limits, singular, residual, label are true")  \
  LAW(AnAskedArmAngleIsKept, redundancy_is_kept, "an asked arm angle is kept")                   \
  LAW(ABranchKeepsItsLimitsAtTheRedundanciesThatAreToldAndNoOthers, redundancy_is_feasible,      \
      "told arm angles are those within limits")                                                 \
  LAW(SingularPosturesAreAnswered, singular_postures, "singular to 0, 1e-9, 1e-7, 1e-4")         \
  LAW(PosturesAtTheJointLimitsAreAnswered, postures_at_limits, "joints at their limits")         \
  LAW(StretchedAndFoldedPosturesAreAnswered, extreme_postures, "stretched, less 1e-9 m, folded") \
  LAW(GoalsOnTheBaseAxisAreAnswered, goals_on_base_axis, "goals on the base axis")               \
  LAW(GoalsStraightUpAndDownAreAnswered, upright_goals, "pointing straight up and down")         \
  LAW(AGoalOutOfReachSaysHowFar, out_of_reach, "out of reach by 1e-9 m, 10 %, metres")           \
  LAW(ASmallChangeOfTheGoalIsASmallChangeOfTheJointsAwayFromSingularPoses, continuity,           \
      "a small change of the goal is one of the joints")                                         \
  LAW(EqualInputGivesEqualBitsFromAnyThread, equal_bits, "equal bits from any thread")           \
  LAW(ABatchIsAnsweredAsItsGoalsAreOneByOne, batch_is_one_by_one, "a batch is as one by one")    \
  LAW(BadInputIsAnsweredAndNotSolved, bad_input, "bad input is answered")                        \
  LAW(SolvingDoesNotAllocate, no_allocation, "solving does not allocate")
