// SPDX-License-Identifier: Apache-2.0
// What an operator's words mean: the ways back.
#include "armature/task/obey.hpp"
#include "implant.hpp"

namespace armature::task::implant {

Expected<void> Implant::hear(const OperatorCommand& command, Time now) {
  if (phase_ == Phase::held && command.word != "abort") {
    return armature::refuse("the tool is held near the jaw: abort leads it out");
  }
  return obey(
      command, procedure_, goal_, [&] { return go_back(now); }, [&] { return abort(); });
}

/// Out of the bone, where its step asks again; from above the first site, and before, to the
/// registration.
Expected<void> Implant::go_back(Time now) {
  switch (phase_) {
    case Phase::going_back:
    case Phase::aborting:
      return armature::refuse(procedure_.paused()
                                  ? "the tool is paused on its way back: resume goes on with it"
                                  : "the tool goes back already");
    case Phase::withdrawing:
    case Phase::changing_tool:
      return armature::refuse("the sites are drilled, or served: the tool is out");
    case Phase::approaching:
    case Phase::drilling:
    case Phase::placing: break;
    default: return armature::refuse("before the approach there is no step to go back to");
  }
  const bool in_site = !goal_.left();
  const bool again = phase_ == Phase::approaching || (pass_ == 0 && !in_site);
  const bool placed = placing() && (in_site ? !pass().asks && !pass().turns : pass().asks);
  if (!again && placed) return armature::refuse("the implant before stays where it was placed");
  if (const auto may = goal_.may_move(); !may && !again) return may;
  procedure_.turn_back();
  goal_.leave();
  if (again) {
    register_again("");
  } else if (!in_site) {
    --pass_;
    come_to_pass(first_of_step(), now);  // into the site before
  } else {
    phase_ = Phase::going_back;
  }
  return {};
}

void Implant::see_jaw_moved(const std::string& why) {
  const bool nothing_set_out =
      phase_ == Phase::locating || (phase_ == Phase::approaching && !under_way());
  if (procedure_.auto_confirm() || !nothing_set_out) return refuse(why);
  goal_.leave();
  register_again(why);
}

void Implant::register_again(const std::string& why) {
  guidance_.register_again(why);
  trouble_.clear();
  homing_ = has_left();
  phase_ = Phase::registering;
  procedure_.enter(kRegistration);
}

/// Out of the bone, over the sites, and to where the approach began.
Expected<void> Implant::abort() {
  if (phase_ == Phase::aborting) return armature::refuse("it is being aborted already");
  if (const auto may = goal_.may_move(); !may && near_the_jaw()) return may;
  procedure_.turn_back();
  if (near_the_jaw()) {
    const bool goes_out =
        phase_ == Phase::going_back && goal_.state() != PursuedGoal::State::pausing;
    trouble_.clear();
    led_out_anyhow_ = phase_ == Phase::held;
    phase_ = Phase::aborting;
    if (goes_out) {
      turn_back();
    } else {
      goal_.leave();
    }
    return {};
  }
  goal_.leave();
  phase_ = Phase::aborted;
  procedure_.end(Procedure::StepState::broken_off);
  return {};
}

void Implant::turn_back() {
  const bool approached = procedure_.step() > rounds_[round_].approach;
  if (!approached && !homing_) {
    homing_ = true;
    return goal_.retrace(false);
  }
  if (thread()) {
    constexpr double kAtMouth_m = 1e-4;
    if (thread()->advance_m(tool()) > kAtMouth_m) return turn_out();
    thread_watch_.release();
  }
  if (phase_ == Phase::aborting) return lead_out();
  goal_.set_once(way_out(rounds_[round_].way, tool(), pass().site));
}

void Implant::turn_out() {
  MotionGoal out = rounds_[round_].way.passes[pass_ - 1].goal;
  out.through.clear();
  out.max_speed = pass().goal.max_speed;
  goal_.set_once(out);
}

void Implant::lead_out() {
  const SiteWay& way = rounds_[round_].way;
  homing_ = homing_ || is_above(way, tool(), 0);
  if (homing_) return goal_.set_once({.pose = *came_from_});
  goal_.set_once(way_out(way, tool(), 0));
}

void Implant::come_back(Time now) {
  if (goal_.state() == PursuedGoal::State::failed) {
    return refuse("the way back: " + goal_.reason());
  }
  if (thread()) {
    thread_watch_.release();
    return goal_.leave();
  }
  if (phase_ == Phase::aborting && !homing_) {
    homing_ = true;
    return lead_out();
  }
  if (phase_ == Phase::aborting) {
    phase_ = Phase::aborted;
    return procedure_.end(Procedure::StepState::broken_off);
  }
  come_to_pass(first_of_step(), now);
}

}  // namespace armature::task::implant
