// SPDX-License-Identifier: Apache-2.0
#include "implant.hpp"

#include <fmt/format.h>

#include <algorithm>

namespace armature::task::implant {
namespace {

using Eigen::Isometry3d;

Destination destination(const GuidedChain& chain, const Isometry3d& image_T_place) {
  return {chain.flange_T_tool().translation(), chain.base_T_site(image_T_place).translation()};
}

}  // namespace

Implant::Implant(const Parameters& parameters, const RobotModel& robot,
                 const Isometry3d& flange_T_file_tool)
    : parameters_{parameters},
      flange_T_file_tool_{flange_T_file_tool},
      procedure_{{{.name = "pivot"},
                  {.name = "calibration"},
                  {.name = "registration"},
                  {.name = "approach", .asks = true},
                  {.name = "drilling", .asks = true}},
                 parameters.auto_confirm},
      guidance_{parameters, robot, flange_T_file_tool.linear()},
      thread_watch_{parameters} {}

void Implant::begin(Time now) { guidance_.begin(now); }

void Implant::see_plan(const std::vector<ToolPose>& sites,
                       const std::vector<PlannedImplant>& implants) {
  if (phase_ == Phase::refused) return;
  const auto sound = guidance_.see_plan(sites, implants);
  if (!sound) refuse(sound.error().text);
}

void Implant::see_arm(const Isometry3d& base_T_flange) {
  base_T_flange_ = base_T_flange;
  guidance_.see_arm(base_T_flange);
  if (at_sites()) rounds_[round_].bottoms.see(base_T_flange);
}

void Implant::see_handpiece(double angle, Time now) {
  guidance_.see_handpiece();
  thread_watch_.see(angle, now);
}

void Implant::see_drill_in_hand(const Sighting& sighting) {
  if (phase_ == Phase::pivoting) guidance_.see_drill_in_hand(sighting);
}

void Implant::see_driver_in_hand(const Sighting& sighting) {
  if (phase_ == Phase::pivoting) guidance_.see_driver_in_hand(sighting);
}

void Implant::see_flange(const Sighting& sighting, Time now) {
  const auto agrees = guidance_.see_flange(sighting, base_T_flange_, watches_the_jaw(), now);
  if (!agrees) refuse(agrees.error().text);
}

void Implant::see_jaw(const Sighting& sighting) {
  const auto rests = guidance_.see_jaw(sighting, watches_the_jaw());
  if (!rests) see_jaw_moved(rests.error().text);
}

void Implant::see_registration(const RegisteredJaw& jaw, Time now) {
  if (phase_ != Phase::registering) return;
  const auto registered = guidance_.see_registration(jaw, now);
  if (!registered) return refuse(registered.error().text);
  phase_ = Phase::locating;
}

void Implant::hear(const GoalReport& report, Time now) {
  goal_.hear(report, now);
  const bool there = goal_.state() == PursuedGoal::State::done;
  const bool failed = goal_.state() == PursuedGoal::State::failed;
  const bool back = phase_ == Phase::going_back || phase_ == Phase::aborting;
  if (back && (there || failed)) return come_back(now);
  if (phase_ == Phase::calibrating && sent_to_ == guidance_.calibration().number()) {
    if (there) guidance_.calibration().arrive(goal_.done_at());
    // Or it would go on with the poses that it has, and move once somebody rearms the arm.
    if (failed && goal_.stopped()) return refuse("hand-eye: " + goal_.reason());
    if (failed) guidance_.calibration().leave_out(goal_.reason());
  }
  const bool above = phase_ == Phase::approaching, out = phase_ == Phase::withdrawing;
  if (failed && (above || out || at_sites())) {
    const std::string why = (above ? "above site 1"
                             : out ? "withdrawal"
                                   : pass().name) +
                            ": " + goal_.reason();
    if (above && !under_way()) return refuse_approach(why, now);
    if (at_sites() && pass().asks && goal_.stopped_before_it_began()) return ask_again(why, now);
    return refuse(why);
  }
  if (there && above) come_to_pass(0, now);
  if (there && out && homing_) return finish_round(now);
  if (there && out) {
    homing_ = true;
    lead_out();
  }
}

void Implant::update(Time now) {
  if (phase_ == Phase::refused || phase_ == Phase::held) return;
  if (base_T_flange_ && !led_out_anyhow_) {
    const auto wrong = thread_watch_.trouble(tool(), now);
    if (wrong) return refuse(pass().name + ": " + *wrong);
  }
  if (procedure_.paused() && !watches_the_jaw()) return;
  switch (phase_) {
    case Phase::pivoting:
    case Phase::calibrating:
    case Phase::registering:
    case Phase::locating: return find(now);
    case Phase::approaching:
    case Phase::drilling:
    case Phase::placing:
      if (const auto seen = guidance_.guard(now); !seen) return refuse(seen.error().text);
      if (goal_.left()) return set_out(now);
      if (at_sites() && procedure_.may_act()) go_on(now);
      break;
    case Phase::withdrawing:
      if (goal_.left()) set_out(now);
      break;
    case Phase::changing_tool:
      // Not at once: whoever watches is told of it.
      if (procedure_.may_act() && now > out_at_) enter_approach(now);
      break;
    case Phase::going_back:
    case Phase::aborting:
      if (goal_.is_free() && procedure_.may_act()) turn_back();
      break;
    case Phase::drilled:
    case Phase::placed:
    case Phase::held:
    case Phase::aborted:
    case Phase::refused: break;
  }
}

void Implant::find(Time now) {
  const Guidance::Step before = guidance_.step();
  const auto found = guidance_.update(now);
  if (!found) return refuse(found.error().text);
  const bool goes_on = guidance_.step() != before;
  switch (guidance_.step()) {
    case Guidance::Step::hand_eye:
      if (!goes_on) return go_on_calibrating();
      phase_ = Phase::calibrating;
      return procedure_.enter(kCalibration);
    case Guidance::Step::registration:
      if (!goes_on) return;
      phase_ = Phase::registering;
      return procedure_.enter(kRegistration);
    case Guidance::Step::complete:
      plan_rounds();
      if (base_T_flange_ && !came_from_) {
        const Isometry3d at = *base_T_flange_ * flange_T_file_tool_;
        came_from_ = {at.translation(), Eigen::Quaterniond{at.linear()}.normalized()};
      }
      return enter_approach(now);
    case Guidance::Step::pivot:
    case Guidance::Step::place: return;
  }
}

void Implant::go_on_calibrating() {
  if (sent_to_ == guidance_.calibration().number()) return;
  sent_to_ = guidance_.calibration().number();
  goal_.set({.pose = *guidance_.calibration().destination()});
}

void Implant::plan_rounds() {
  rounds_.clear();
  const std::vector<Isometry3d>& sites = guidance_.sites();
  const std::vector<PlannedImplant>& implants = guidance_.implants();
  std::vector<Destination> bottoms;
  for (const Isometry3d& site : sites) bottoms.push_back(destination(guidance_.chain(), site));
  rounds_.push_back(
      {.way = drilling_way(guidance_.chain(), flange_T_file_tool_, sites, parameters_),
       .bottoms = {bottoms, "the drill", "the bottom of"}});
  if (const auto driver = guidance_.driver_chain()) {
    bottoms.clear();
    for (std::size_t i = 0; i < sites.size(); ++i) {
      bottoms.push_back(
          destination(with_implant(*driver, implants[i]), place_of(sites[i], implants[i])));
    }
    rounds_.push_back(
        {.way = placing_way(*driver, flange_T_file_tool_, sites, implants, parameters_),
         .bottoms = {bottoms, "the implant", "its place in"}});
  }
  std::vector<Procedure::Step> ahead;
  for (Round& round : rounds_) {
    const bool first = &round == &rounds_.front();
    if (!first) ahead.push_back({.name = "tool change", .asks = true});
    round.approach = kApproach + ahead.size();
    ahead.push_back({.name = first ? "approach" : "second approach", .asks = true});
    for (const Pass& pass : round.way.passes) {
      if (pass.asks) ahead.push_back({.name = pass.name, .asks = true});
    }
    round.withdrawal = kApproach + ahead.size();
    ahead.push_back({.name = first ? "withdrawal" : "last withdrawal"});
  }
  procedure_.set_steps_ahead(ahead);
}

void Implant::enter_approach(Time now) {
  goal_.leave();
  phase_ = Phase::approaching;
  guidance_.begin_to_guard(now);
  procedure_.enter(rounds_[round_].approach);
  set_out(now);
}

void Implant::refuse_approach(const std::string& why, Time now) {
  if (procedure_.auto_confirm()) return refuse(why);
  enter_approach(now);
  trouble_ = why;
}

void Implant::ask_again(const std::string& why, Time now) {
  if (procedure_.auto_confirm()) return refuse(why);
  come_to_pass(pass_, now);
  trouble_ = why;
}

void Implant::set_out(Time now) {
  if (!procedure_.may_act()) return;
  trouble_.clear();
  const SiteWay& way = rounds_[round_].way;
  switch (phase_) {
    case Phase::approaching:
      homing_ = has_left();  // not back along the last way, which may be that out of a bore
      return goal_.set_once({.pose = way.above.front()});
    case Phase::withdrawing: return lead_out();
    default:
      if (pass().turns) {
        const std::size_t site = pass().site;
        const Isometry3d base_T_site = guidance_.chain().base_T_site(guidance_.sites()[site]);
        thread_watch_.engage({.start = way.passes[pass_ - 1].goal.pose.position,
                              .axis = base_T_site.linear().col(2),
                              .pitch_m = guidance_.implants()[site].pitch_m},
                             now);
      }
      return goal_.set_once(way_in(way, tool(), pass()));
  }
}

void Implant::come_to_pass(std::size_t pass, Time now) {
  phase_ = placing() ? Phase::placing : Phase::drilling;
  thread_watch_.release();
  pass_ = pass;
  goal_.leave();
  homing_ = false;
  if (this->pass().asks) {
    const auto& passes = rounds_[round_].way.passes;
    const auto steps = std::count_if(passes.begin(), passes.begin() + static_cast<int>(pass_),
                                     [](const Pass& before) { return before.asks; });
    procedure_.enter(rounds_[round_].approach + 1 + static_cast<std::size_t>(steps));
  }
  set_out(now);
}

std::size_t Implant::first_of_step() const {
  std::size_t first = pass_;
  while (!rounds_[round_].way.passes[first].asks) --first;
  return first;
}

void Implant::go_on(Time now) {
  if (goal_.state() != PursuedGoal::State::done) return;
  if (pass().ends_at_bottom && now - goal_.done_at() < seconds(parameters_.dwell)) return;
  const Round& round = rounds_[round_];
  const auto missed = round.bottoms.missed(pass().sites, parameters_.max_bottom_error);
  if (missed) return refuse(*missed);
  if (pass_ + 1 < round.way.passes.size()) return come_to_pass(pass_ + 1, now);
  goal_.leave();
  phase_ = Phase::withdrawing;
  procedure_.enter(rounds_[round_].withdrawal);
  set_out(now);
}

void Implant::finish_round(Time now) {
  if (round_ + 1 == rounds_.size()) {
    phase_ = placing() ? Phase::placed : Phase::drilled;
    return procedure_.end();
  }
  out_at_ = now;
  ++round_;
  pass_ = 0;
  phase_ = Phase::changing_tool;
  procedure_.enter(rounds_[round_].approach - 1);
}

bool Implant::has_left() const {
  constexpr double kAtRest_m = 1e-3;
  return came_from_ && (tool() - came_from_->position).norm() > kAtRest_m;
}

bool Implant::near_the_jaw() const {
  switch (phase_) {
    case Phase::registering:
    case Phase::locating: return has_left();
    case Phase::approaching: return under_way() || has_left();
    case Phase::drilling:
    case Phase::placing:
    case Phase::withdrawing:
    case Phase::going_back:
    case Phase::held:
    case Phase::aborting: return true;
    default: return false;
  }
}

void Implant::refuse(const std::string& why) {
  if (phase_ == Phase::refused || phase_ == Phase::held) return;
  const bool held = near_the_jaw() && !procedure_.auto_confirm();
  phase_ = held ? Phase::held : Phase::refused;
  trouble_ = why;
  if (held) {
    procedure_.turn_back();
  } else {
    procedure_.end(Procedure::StepState::broken_off);
  }
  if (goal_.on_its_way()) goal_.set({.mode = MotionMode::hold, .pose = {}});
}

const char* to_string(Implant::Phase phase) {
  switch (phase) {
    case Implant::Phase::pivoting: return "pivoting";
    case Implant::Phase::calibrating: return "calibrating";
    case Implant::Phase::registering: return "registering";
    case Implant::Phase::locating: return "locating";
    case Implant::Phase::approaching: return "approaching";
    case Implant::Phase::drilling: return "drilling";
    case Implant::Phase::placing: return "placing";
    case Implant::Phase::withdrawing: return "withdrawing";
    case Implant::Phase::changing_tool: return "changing tool";
    case Implant::Phase::drilled: return "drilled";
    case Implant::Phase::placed: return "placed";
    case Implant::Phase::going_back: return "going back";
    case Implant::Phase::held: return "held";
    case Implant::Phase::aborting: return "aborting";
    case Implant::Phase::aborted: return "aborted";
    case Implant::Phase::refused: return "refused";
  }
  return "";
}

}  // namespace armature::task::implant
