// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <ostream>
#include <span>
#include <string>

#include "armature/kinds/select/select.hpp"
#include "armature/laws/law.hpp"

// The laws that every `select` plugin keeps, for any robot.
namespace armature ARMATURE_EXPORT {

/// A selector made for a robot.
struct SelectSubject {
  std::string name;
  std::shared_ptr<const RobotModel> model;
  std::shared_ptr<const BranchSelector> selector;

  friend void PrintTo(const SelectSubject& subject, std::ostream* out) { *out << subject.name; }
};

std::span<const Law<SelectSubject>> select_laws();

}  // namespace armature

// The laws by name: LAW(TheSentence, the_function, "in short").
#define ARMATURE_SELECT_LAWS(LAW)                                                                  \
  LAW(ChoosesABranchOfEveryWaypointWithinLimitsAndNearTheOneBefore, chooses_near,                  \
      "a branch of every waypoint, within limits")                                                 \
  LAW(AnOnlyBranchIsFollowedOverWholeTurns, follows_turns,                                         \
      "an only branch is followed over whole turns")                                               \
  LAW(AsManyBranchesAsThereMayBeAreConsidered, full_waypoints, "as many branches as there may be") \
  LAW(NamesTheWaypointThatHasNoBranchWithinLimits, names_waypoint,                                 \
      "a waypoint without a branch is named")                                                      \
  LAW(RefusesJointPositionsThatAreNone, refuses_bad, "bad joint positions are refused")            \
  LAW(EqualInputGivesEqualBits, equal_input, "equal input gives equal bits")                       \
  LAW(NoWaypointsAreAnEmptyPath, no_waypoints, "no waypoints are an empty path")
