// SPDX-License-Identifier: Apache-2.0
#include "biopsy.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <utility>

#include "armature/task/obey.hpp"

namespace armature::task::biopsy {

using Eigen::Vector3d;

Biopsy::Biopsy(const Parameters& parameters, const RobotModel& robot)
    : parameters_{parameters},
      robot_{robot},
      touching_{parameters},
      procedure_{steps(), parameters.auto_confirm} {}

std::vector<Procedure::Step> Biopsy::steps() const {
  std::vector<Procedure::Step> steps;
  if (parameters_.touch_markers) steps.push_back({.name = "hand guidance"});
  for (std::size_t i = 1; i <= touching_.count(); ++i) {
    steps.push_back({.name = fmt::format("marker {}", i), .asks = true});
  }
  steps.push_back({.name = "registration"});
  for (const char* name : {"approach", "entry", "insertion"}) {
    steps.push_back({.name = name, .asks = true});
  }
  steps.push_back({.name = "withdrawal"});
  return steps;
}

Biopsy::Step Biopsy::step() const {
  constexpr auto kBehindTouching = static_cast<std::size_t>(Step::withdrawal);
  const std::size_t ahead = procedure_.steps().size() - procedure_.step();
  return ahead > kBehindTouching ? Step::touching : static_cast<Step>(1 + kBehindTouching - ahead);
}

void Biopsy::enter(Step step) {
  const std::size_t touches = parameters_.touch_markers ? 1 + touching_.count() : 0;
  procedure_.enter(touches + static_cast<std::size_t>(step) - 1);
}

void Biopsy::see_head(const NeedleLine& plan, const std::vector<Vector3d>& markers, Time now) {
  if (has_plan_) return;
  plan_ = plan;
  has_plan_ = true;
  if (const auto wrong = defect(plan, parameters_.max_entry_depth)) return refuse(*wrong);
  if (!parameters_.touch_markers) return;
  constexpr std::size_t kFewest = 3;
  if (markers.size() < kFewest) {
    return refuse(fmt::format("the plan has {} markers, at least {} tell how a head lies",
                              markers.size(), kFewest));
  }
  touching_.begin(markers);
  const auto all = steps();
  procedure_.set_steps_ahead({all.begin() + 1, all.end()});
  give_to_hand(now);
}

void Biopsy::see_registration(const RegisteredHead& head, Time now) {
  if (!wants_registration()) return;
  if (!(head.fiducial_error_m <= parameters_.max_fre)) {
    return refuse_registration(fmt::format("the markers fit to {:.2f} mm rms, {:g} mm are allowed",
                                           1e3 * head.fiducial_error_m, 1e3 * parameters_.max_fre),
                               now);
  }
  if (!(head.target_error95_m <= parameters_.max_tre)) {
    return refuse_registration(
        fmt::format("the target is known to {:.2f} mm (95 %), {:g} mm are required",
                    1e3 * head.target_error95_m, 1e3 * parameters_.max_tre),
        now);
  }
  line_ = registered(plan_, head.robot_T_image, head.target_error95_m);
  enter(Step::approach);
}

void Biopsy::update(Time now) {
  if (!procedure_.may_act()) return;
  const bool turns = heading_ != Heading::none && goal_.is_free();
  if (turns) return has_set_out() ? retrace(heading_) : turn_at_once(now);
  if (heading_ != Heading::none) return;
  switch (step()) {
    case Step::touching: touch_by_itself(now); break;
    case Step::registration: break;
    case Step::approach:
      if (!has_left_hand(now)) break;
      [[fallthrough]];
    case Step::entry:
    case Step::insertion: set_out(); break;
    case Step::withdrawal:
      // One step at least, in which it says that it is there.
      if (now > at_target_since_ && now - at_target_since_ >= seconds(parameters_.dwell)) {
        retrace(Heading::out);
      }
      break;
  }
}

/// The whole way is planned before anything moves; then it is gone on with, stop by stop.
void Biopsy::set_out() {
  trouble_.clear();
  heading_ = Heading::onward;
  if (way_stops_ > 0) return goal_.go_on();
  goal_.set_once({.pose = pose_at_target(*line_, robot_),
                  .focus = line_->entry,
                  .forbidden = zones_of(*line_),
                  .stepwise = true});
}

void Biopsy::retrace(Heading heading) {
  trouble_.clear();
  heading_ = heading;
  goal_.retrace(heading != Heading::home);
}

void Biopsy::turn_at_once(Time now) {
  trouble_.clear();
  if (std::exchange(heading_, Heading::none) == Heading::home) return end_aborted();
  ask_again(now);
}

void Biopsy::ask_again(Time now) {
  if (parameters_.touch_markers) give_to_hand(now);
  enter(Step::approach);
}

void Biopsy::forget_line() {
  line_.reset();
  way_stops_ = 0;
}

void Biopsy::end_aborted() {
  ended_as_ = Phase::aborted;
  procedure_.end(Procedure::StepState::broken_off);
}

void Biopsy::hear(const GoalReport& report, Time now) {
  const bool was_led = led();
  goal_.hear(report, now);
  if (led() && !was_led) touching_.begin_rest();
  if (in_hand() && goal_.state() == PursuedGoal::State::failed) return refuse(goal_.reason());
  if (procedure_.over() || heading_ == Heading::none || heading_ == Heading::held) return;
  if (goal_.state() == PursuedGoal::State::failed) {
    return break_down((heading_ == Heading::onward ? "" : "the way back failed: ") + goal_.reason(),
                      now);
  }
  if (goal_.state() == PursuedGoal::State::done) arrive(now);
}

void Biopsy::arrive(Time now) {
  const Heading came = std::exchange(heading_, Heading::none);
  const int ahead = goal_.stops_ahead();
  if (way_stops_ == 0 && came == Heading::onward) way_stops_ = ahead + 1;
  place_ = came == Heading::onward ? way_stops_ - ahead : ahead;
  if (came == Heading::home) return end_aborted();
  if (came != Heading::out) {
    if (place_ == way_stops_) at_target_since_ = now;
    return enter(step_from(place_));
  }
  // Back to the stand-off; the entry on the way there is passed.
  const int stand_off = std::max(way_stops_ - 2, 0);
  if (place_ > stand_off) return retrace(Heading::out);
  ended_as_ = Phase::withdrawn;
  procedure_.end();
}

Biopsy::Step Biopsy::step_from(int place) const {
  if (way_stops_ == 0) return Step::approach;
  if (place == way_stops_) return Step::withdrawal;
  if (place == way_stops_ - 1) return Step::insertion;
  return place == way_stops_ - 2 ? Step::entry : Step::approach;
}

Expected<void> Biopsy::hear(const OperatorCommand& command, Time now) {
  if (heading_ == Heading::held && command.word != "back" && command.word != "abort") {
    return armature::refuse("the needle has broken down on its way: back or abort leads it out");
  }
  const auto obeyed = obey(
      command, procedure_, goal_, [&] { return go_back(now); }, [&] { return abort(); });
  if (!obeyed) return obeyed;
  if (command.word == "resume") waits_since_ = now;
  return command.word == "confirm" ? begin_confirmed(now) : obeyed;
}

Expected<void> Biopsy::begin_confirmed(Time now) {
  if (step() == Step::touching) return touch(now);
  const auto clear = may_leave_hand(now);
  if (!clear) procedure_.enter(procedure_.step());
  return clear;
}

Expected<void> Biopsy::go_back(Time now) {
  if (heading_ > Heading::onward) {
    return armature::refuse(procedure_.paused()
                                ? "the needle is paused on its way back: resume goes on with it"
                                : "the needle goes back already");
  }
  if (!stands_where_it_began()) return turn(Heading::back);
  const bool touches = parameters_.touch_markers;
  if (touches ? touching_.places().empty() : step() == Step::registration) {
    return armature::refuse("there is no step before this one");
  }
  if (touches) {
    touch_again(now);
  } else {
    procedure_.turn_back();
    forget_line();
    enter(Step::registration);
  }
  return {};
}

Expected<void> Biopsy::abort() {
  if (heading_ == Heading::home) return armature::refuse("it is being aborted already");
  if (!stands_where_it_began()) return turn(Heading::home);
  take_from_hand();
  end_aborted();
  return {};
}

Expected<void> Biopsy::turn(Heading heading) {
  if (const auto may = goal_.may_move(); !may) return may;
  procedure_.turn_back();
  goal_.leave();
  heading_ = heading;
  return {};
}

void Biopsy::break_down(const std::string& why, Time now) {
  if (parameters_.auto_confirm) return refuse(why);
  trouble_ = why;
  heading_ = has_set_out() ? Heading::held : Heading::none;
  if (heading_ == Heading::none) ask_again(now);
}

void Biopsy::refuse(const std::string& why) {
  trouble_ = why;  // which may be the goal's
  take_from_hand();
  ended_as_ = Phase::refused;
  procedure_.end(Procedure::StepState::broken_off);
}

Biopsy::Phase Biopsy::phase() const {
  if (procedure_.over()) return ended_as_;
  switch (heading_) {
    case Heading::held: return Phase::held;
    case Heading::onward: return Phase::moving;
    case Heading::back: return Phase::going_back;
    case Heading::out: return Phase::withdrawing;
    case Heading::home: return Phase::aborting;
    case Heading::none: break;
  }
  if (step() == Step::touching) {
    return procedure_.step() > 0 ? Phase::touching : Phase::waiting;
  }
  if (procedure_.asks()) return Phase::asking;
  if (step() == Step::registration) return has_plan_ ? Phase::registering : Phase::waiting;
  return step() == Step::withdrawal ? Phase::at_target : Phase::moving;
}

const char* to_string(Biopsy::Phase phase) {
  switch (phase) {
    case Biopsy::Phase::waiting: return "waiting";
    case Biopsy::Phase::touching: return "touching";
    case Biopsy::Phase::registering: return "registering";
    case Biopsy::Phase::asking: return "asking";
    case Biopsy::Phase::moving: return "moving";
    case Biopsy::Phase::at_target: return "at target";
    case Biopsy::Phase::withdrawing: return "withdrawing";
    case Biopsy::Phase::going_back: return "going back";
    case Biopsy::Phase::aborting: return "aborting";
    case Biopsy::Phase::held: return "held";
    case Biopsy::Phase::withdrawn: return "withdrawn";
    case Biopsy::Phase::aborted: return "aborted";
    case Biopsy::Phase::refused: return "refused";
  }
  return "";
}

}  // namespace armature::task::biopsy
