// SPDX-License-Identifier: Apache-2.0
// What a biopsy does while a hand leads its arm from marker to marker.
#include <fmt/core.h>

#include "biopsy.hpp"

namespace armature::task::biopsy {

bool Biopsy::in_hand() const {
  return parameters_.touch_markers && has_plan_ && !procedure_.over() && way_stops_ == 0 &&
         heading_ == Heading::none;
}

void Biopsy::give_to_hand(Time now) {
  waits_since_ = now;
  goal_.set({.mode = MotionMode::guided, .pose = {}});
}

void Biopsy::hold() {
  if (!parameters_.touch_markers || way_stops_ > 0) return;
  goal_.set({.mode = MotionMode::hold, .pose = {}});
}

void Biopsy::touch_by_itself(Time now) {
  if (!has_plan_) return;
  if (procedure_.step() == 0) {
    waits_since_ = now;
    if (goal_.state() == PursuedGoal::State::moving) procedure_.enter_next();
    return;
  }
  if (touching_.rests_anew(now)) {
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
  if (const auto taken = touching_.take(now); !taken) {
    procedure_.enter(procedure_.step());  // and asks again
    return taken;
  }
  trouble_.clear();
  waits_since_ = now;
  procedure_.enter_next();
  return {};
}

Expected<void> Biopsy::touch_again(Time now) {
  if (touching_.places().empty()) return armature::refuse("there is no step before this one");
  touching_.drop_last();
  procedure_.turn_back();
  trouble_.clear();
  line_.reset();
  way_stops_ = 0;
  give_to_hand(now);
  procedure_.enter(1 + touching_.places().size());
  return {};
}

Expected<void> Biopsy::may_leave_hand(Time now) const {
  if (!in_hand()) return {};
  return touching_.is_clear(now);
}

/// An operator has confirmed that it was.
bool Biopsy::waits_to_be_led_away(Time now) {
  if (!procedure_.auto_confirm() || !in_hand()) return false;
  const auto clear = may_leave_hand(now);
  if (clear) trouble_.clear();
  if (!clear && trouble_.empty()) trouble_ = clear.error().text;  // said once, not at every step
  if (!clear) wait_for_hand({"the tip was not led away from the markers", clear.error().text}, now);
  return !clear;
}

void Biopsy::refuse_registration(const std::string& why, Time now) {
  if (!parameters_.touch_markers || procedure_.auto_confirm()) return refuse(why);
  if (touch_again(now)) trouble_ = why;
}

}  // namespace armature::task::biopsy
