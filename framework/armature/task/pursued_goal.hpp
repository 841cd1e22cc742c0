// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>

#include "armature/motion/goal.hpp"
#include "armature/values/expected.hpp"
#include "armature/values/time.hpp"

namespace armature ARMATURE_EXPORT {

/// The one goal that a task has the arm on its way to. Goals that were refused because the motion
/// was not ready, and goals that nobody answered, are given again, for as long as the task asks for
/// the `outgoing` one. A goal that breaks down on its way, since the arm does not follow, is given
/// again, too, but not three times within 5 s, nor to an arm that is not ready within 5 s: it has
/// failed then, since an arm whose power comes back must not move because of what was wanted
/// before. A goal that was stopped until a rearm has failed, also one that was being paused:
/// nothing moves because of the rearm, nor of a resume. One that lets a hand move the arm moves
/// nothing by itself, and is given again.
class PursuedGoal {
 public:
  enum class State { none, waiting, moving, pausing, paused, done, failed };

  /// Makes `goal` the current one; it is sent with the next `outgoing`.
  void set(const MotionGoal& goal);
  /// The same of a goal that must not be begun a second time, as where the arm then stands is not
  /// where its way begins (a needle in tissue): it has failed when it breaks down on its way.
  void set_once(const MotionGoal& goal);
  /// Stops an arm that is on its way, along the way where that can be. `hear` tells when it is
  /// paused. Of a goal that has been done, or has failed, nothing moves: nothing to do.
  void pause();
  /// Stops it in the same way and gives its goal up: a resume does not go on with it. Of one that
  /// has been done, or has failed, nothing is heard any more.
  void leave();
  /// Goes on after a pause: a goal that must not be begun a second time along its way, any other
  /// from where the arm is. An arm that still slows down comes to rest first.
  void resume();
  /// Makes "back along the way, as it came" the current goal: to the stop before when `stepwise`,
  /// else to where the way began. For an arm that rests on its way: paused, or done.
  void retrace(bool stepwise);
  /// Makes "on along the way, to its next stop" the current goal.
  void go_on();
  void hear(const GoalReport& report, Time now);
  /// The goal to send now, with its id, if any.
  std::optional<MotionGoal> outgoing(Time now);

  State state() const { return state_; }
  /// Also where it goes on, because of a resume, as soon as the arm has come to rest.
  bool on_its_way() const {
    const bool goes_on = state_ == State::pausing && resumes_;
    return state_ == State::waiting || state_ == State::moving || goes_on;
  }
  /// No goal is pursued: none was set yet, or it was left and no other one set.
  bool left() const;
  /// It is left, and the arm does not slow down from it any more: it may be turned round.
  bool is_free() const { return left() && state_ != State::pausing; }
  /// The arm has moved because of the goal: before a pause of it, or on and back along its way.
  bool has_moved() const { return has_moved_; }
  /// Refuses while the motion tells that the arm is stopped: a word that wants it moved would do
  /// nothing then.
  Expected<void> may_move() const;
  /// It has failed because the arm was stopped.
  bool stopped() const { return state_ == State::failed && stopped_; }
  /// The same before the arm has moved because of it: its step may be asked again.
  bool stopped_before_it_began() const { return stopped() && !has_moved_; }
  Time done_at() const { return done_at_; }
  const std::string& reason() const { return reason_; }
  /// Of a goal that is done: how many stops of its way lie behind it.
  int stops_ahead() const { return stops_ahead_; }
  int sent() const { return sent_; }

 private:
  /// `goal` takes the place of the current one, and may belong to its way.
  void replace_by(const MotionGoal& goal, bool once);
  void give_up_or_try_again(const GoalReport& report, Time now);
  bool worth_another_try(const GoalReport& report, Time now);
  bool breaks_down_for_good(Time now);

  MotionGoal goal_;
  State state_ = State::none;
  std::uint64_t last_id_ = 0;
  std::optional<Time> send_at_;  // not sent yet: at once or later
  Time sent_at_, done_at_;
  std::string reason_;
  struct Interrupted {
    MotionGoal rest;
    bool once = false;
  };
  std::optional<Interrupted> interrupted_;  // by a pause
  bool resumes_ = false;                    // as soon as it is paused
  int stops_ahead_ = 0;
  std::array<std::optional<Time>, 2> broke_down_;  // the last two times, the newest first
  int sent_ = 0;
  bool once_ = false, begun_ = false, accepted_ = false, stopped_ = false, has_moved_ = false;
  bool arm_is_stopped_ = false;
};

}  // namespace armature
