// SPDX-License-Identifier: Apache-2.0
// What an operator's words mean: the ways back.
#include <fmt/format.h>

#include "armature/task/obey.hpp"
#include "lamp_alignment.hpp"

namespace armature::task::lamp_alignment {

Expected<void> LampAlignment::hear(const OperatorCommand& command, Time now) {
  constexpr Duration kReading = seconds(0.5);
  if (command.word == "confirm" && asked_whose_at_ && now - *asked_whose_at_ < kReading) {
    return refuse("another face has just come into the question: look, and say it again");
  }
  if (const auto may = may_resume(now); command.word == "resume" && !may) return may;
  return obey(
      command, procedure_, goals_, [&] { return go_back(now); }, [&] { return abort(); });
}

/// A way to a face that was interrupted is not gone to its end once that face is lost.
Expected<void> LampAlignment::may_resume(Time now) const {
  const bool pauses = goals_.state() == GoalState::pausing || goals_.state() == GoalState::paused;
  const bool interrupted = pauses && !goals_.left();
  const bool to_a_face = step() == Step::alignment && phase_ != Phase::aborting;
  if (!interrupted || !to_a_face || is_fresh(now)) return {};
  return refuse(fmt::format(
      "the face that it was on its way to has not been seen for {:g} s: 'back' searches for it",
      parameters_.lost));
}

Expected<void> LampAlignment::go_back(Time now) {
  if (phase_ == Phase::aborting) return refuse("it is being aborted");
  if (step() != Step::alignment && phase_ != Phase::no_view) {
    return refuse("the search is the first step that moves the lamp");
  }
  if (const auto may = goals_.may_move(); !may) return may;
  procedure_.turn_back();
  goals_.set({.mode = MotionMode::hold, .pose = {}});
  start_search(now);
  return {};
}

/// To the view from which it saw the face, if it has left one; else it stays where it is.
Expected<void> LampAlignment::abort() {
  if (phase_ == Phase::aborting) return refuse("it is being aborted already");
  const bool came_from_a_view = step() == Step::alignment && views_looked_at_ > 0;
  if (const auto may = goals_.may_move(); !may && came_from_a_view) return may;
  procedure_.turn_back();
  MotionGoal goal{.mode = MotionMode::hold, .pose = {}};
  if (came_from_a_view) goal = {.pose = poses_[pose_]};
  if (came_from_a_view || goals_.state() != GoalState::none) goals_.set(goal);
  phase_ = Phase::aborting;
  trouble_.clear();
  capture_ = false;
  return {};
}

void LampAlignment::end_abort() {
  if (goals_.state() == GoalState::failed) trouble_ = "the way back failed: " + goals_.reason();
  if (goals_.on_its_way()) return;
  phase_ = Phase::aborted;
  procedure_.end(Procedure::StepState::broken_off);
}

}  // namespace armature::task::lamp_alignment
