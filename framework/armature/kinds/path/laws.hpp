// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <ostream>
#include <span>
#include <string>

#include "armature/kinds/path/path.hpp"
#include "armature/laws/law.hpp"
#include "armature/robot/model/robot_model.hpp"

// The laws that every `path` plugin keeps.
namespace armature ARMATURE_EXPORT {

struct PathSubject {
  std::string name;
  std::shared_ptr<const PathPlanner> planner;
  /// A goal's axis is a line through the point to look at, and the way along it from before that
  /// point: it is asked for nothing else.
  bool along_a_line = false;
  /// Whose joints a path may name; none: joints are not looked at.
  std::shared_ptr<const RobotModel> model = nullptr;

  friend void PrintTo(const PathSubject& subject, std::ostream* out) { *out << subject.name; }
};

std::span<const Law<PathSubject>> path_laws();

/// `path` answers `request`: from the start without a gap through the key poses to the goal, with
/// finite poses, and at rest at the end.
void check_sound(const Path& path, const PathRequest& request, LawCheck& check);

}  // namespace armature

// The laws by name: LAW(TheSentence, the_function, "in short").
#define ARMATURE_PATH_LAWS(LAW)                                                                  \
  LAW(KeepsAwayFromForbiddenZonesOrRefusesThem, keeps_away, "no path through a forbidden zone")  \
  LAW(StartsAtTheStartGoesWithoutAGapAndEndsAtTheGoal, start_to_goal,                            \
      "from the start to the goal without a gap")                                                \
  LAW(WithoutAPointToLookAtItPlansDirectionsAndRotationsOrRefusesAll, without_focus,             \
      "no point to look at: planned, or all refused")                                            \
  LAW(AStartThatIsTheGoalIsAPathAllTheSame, already_there, "a start that is the goal is a path") \
  LAW(EqualRequestsGiveEqualPaths, equal_requests, "equal requests give equal paths")            \
  LAW(ADirectionThatIsNearlyAUnitIsMadeOne, nearly_unit,                                         \
      "a direction of nearly length 1 is made one")                                              \
  LAW(ARequestThatIsNoneIsRefusedWithItsReason, bad_requests,                                    \
      "bad requests are refused, with the reason")                                               \
  LAW(KeyPosesAreGoneThroughInTheirOrderOrRefused, key_poses,                                    \
      "key poses are gone through, or refused")                                                  \
  LAW(AnAwkwardRequestIsPlannedSoundlyOrRefusedWithAReason, awkward_requests,                    \
      "awkward requests: sound, or refused")
