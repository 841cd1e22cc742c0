// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <ostream>
#include <span>
#include <string>

#include "armature/kinds/trajectory/trajectory_planner.hpp"
#include "armature/laws/law.hpp"

// The laws that every `trajectory` plugin keeps.
namespace armature ARMATURE_EXPORT {

struct TrajectorySubject {
  std::string name;
  std::shared_ptr<const TrajectoryPlanner> planner;
  bool provides_time_law = true;  // as its plugin.yaml says

  friend void PrintTo(const TrajectorySubject& subject, std::ostream* out) { *out << subject.name; }
};

std::span<const Law<TrajectorySubject>> trajectory_laws();

}  // namespace armature

// The laws by name: LAW(TheSentence, the_function, "in short").
#define ARMATURE_TRAJECTORY_LAWS(LAW)                                                     \
  LAW(FromRestItKeepsTheLimitsUsesThemAndHasNoJump, from_rest,                            \
      "from rest it keeps and uses the limits")                                           \
  LAW(FromAMovingStartItLeavesWithoutAJumpWithinTheLimits, from_motion,                   \
      "a moving start is left without a jump")                                            \
  LAW(KeepsAJerkLimitToo, keeps_jerk, "a limit of jerk is kept")                          \
  LAW(PlanningAgainAndAgainOnTheWayStillArrivesInTime, planned_again,                     \
      "planned again and again it arrives")                                               \
  LAW(PassesEveryWaypointOfACurve, passes_waypoints, "every waypoint is passed")          \
  LAW(AViaIsPassedWithoutStopping, passes_vias, "a via is passed without stopping")       \
  LAW(ASegmentsOwnDurationIsKeptExactlyOrRefusedWithTheNeededOne, keeps_durations,        \
      "a segment's duration is kept or refused")                                          \
  LAW(GoingNowhereIsHolding, holds, "going nowhere is holding")                           \
  LAW(AMovingStartThatShallGoNowhereComesBackToRest, comes_to_rest,                       \
      "a moving start comes to rest")                                                     \
  LAW(ATinyMotionHasAFiniteTrajectory, tiny_motion, "a tiny motion is finite")            \
  LAW(EqualRequestsGiveEqualBits, same_trajectory_bits, "equal requests give equal bits") \
  LAW(NumbersFarFromAnyRobotAreRefusedOrKept, far_numbers,                                \
      "numbers far from any robot are refused or kept")                                   \
  LAW(ARequestThatContradictsItselfIsRefusedWithAReason, refuses_contradictions,          \
      "a bad request is refused")
