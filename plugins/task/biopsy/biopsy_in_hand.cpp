// SPDX-License-Identifier: Apache-2.0
// What a biopsy does while a hand leads its arm from marker to marker.
#include <fmt/core.h>

#include "biopsy.hpp"

namespace armature::task::biopsy {

bool Biopsy::in_hand() const {
  return parameters_.touch_markers && has_plan_ && !procedure_.over() && way_stops_ == 0 &&
         heading_ == Heading::none;
}

bool Biopsy::led() const {
  return in_hand() && !takes_back_ && goal_.state() == PursuedGoal::State::moving;
}

void Biopsy::give_to_hand(Time now) {
  waits_since_ = now;
  takes_back_ = false;
  goal_.set({.mode = MotionMode::guided, .pose = {}});
  if (procedure_.paused()) goal_.pause();
}

void Biopsy::take_from_hand() {
  if (!in_hand()) return;
  takes_back_ = true;
  goal_.set({.mode = MotionMode::hold, .pose = {}});
}

void Biopsy::touch_by_itself(Time now) {
  if (!has_plan_) return;
  if (procedure_.step() == 0) {
    if (!led()) return wait_for_hand({"the arm was not given to a hand", goal_.reason()}, now);
    waits_since_ = now;
    procedure_.enter_next();
    return;
  }
  if (led() && touching_.rests_anew(now)) {
    if (const auto taken = touch(now); !taken) trouble_ = taken.error().text;
    return;
  }
  const auto place = touching_.place(now);
  const std::string last = trouble_.empty() && !place ? place.error().text : trouble_;
  wait_for_hand({fmt::format("{} of {} was not touched", procedure_.steps()[procedure_.step()].name,
                             touching_.count()),
                 last},
                now);
}

void Biopsy::wait_for_hand(const Wait& wait, Time now) {
  if (now - waits_since_ < seconds(parameters_.touch_timeout)) return;
  refuse(fmt::format("{} for {:g} s (touch_timeout_s){}{}", wait.what, parameters_.touch_timeout,
                     wait.last.empty() ? "" : ": ", wait.last));
}

Expected<void> Biopsy::touch(Time now) {
  const auto taken = led() ? touching_.take(now)
                           : armature::refuse("the arm is in no hand: its tip touches nothing");
  if (!taken) {
    procedure_.enter(procedure_.step());  // and asks again
    return taken;
  }
  trouble_.clear();
  waits_since_ = now;
  procedure_.enter_next();
  return {};
}

void Biopsy::touch_again(Time now) {
  touching_.drop_last();
  procedure_.turn_back();
  trouble_.clear();
  forget_line();
  give_to_hand(now);
  procedure_.enter(1 + touching_.places().size());
}

Expected<void> Biopsy::may_leave_hand(Time now) const {
  if (!in_hand()) return {};
  return touching_.is_clear(now);
}

bool Biopsy::has_left_hand(Time now) {
  if (!in_hand()) return true;
  if (takes_back_ && goal_.state() != PursuedGoal::State::done) return false;
  const auto clear = may_leave_hand(now);
  if (clear && takes_back_) {
    trouble_.clear();
    return true;
  }
  if (clear) {
    take_from_hand();
    return false;
  }
  if (takes_back_) give_to_hand(now);
  if (trouble_.empty()) trouble_ = clear.error().text;  // said once, not at every step
  if (!procedure_.auto_confirm()) {
    procedure_.enter(procedure_.step());  // and asks again
    return false;
  }
  wait_for_hand({"the tip was not led away from the head", clear.error().text}, now);
  return false;
}

void Biopsy::refuse_registration(const std::string& why, Time now) {
  const bool touched = parameters_.touch_markers && !touching_.places().empty();
  if (!touched || procedure_.auto_confirm()) return refuse(why);
  touch_again(now);
  trouble_ = why;
}

}  // namespace armature::task::biopsy
