// SPDX-License-Identifier: Apache-2.0
#include "implant.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

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
      calibration_{parameters, robot},
      drill_{parameters, "the drill"},
      driver_{parameters, "the driver"},
      flange_watch_{"the flange", seconds(parameters.timeout)},
      jaw_watch_{"the jaw", seconds(parameters.timeout)},
      thread_watch_{parameters},
      jaw_{parameters} {
  chain_.flange_R_tool = flange_T_file_tool.linear();
}

void Implant::begin(Time now) { enter(Phase::pivoting, now); }

void Implant::enter(Phase phase, Time now) {
  phase_ = phase;
  if (phase == Phase::pivoting) drill_.begin(now);
  if (phase == Phase::locating || phase == Phase::approaching) jaw_watch_.begin(now);
  if (phase == Phase::approaching) flange_watch_.begin(now);
}

void Implant::see_plan(const std::vector<ToolPose>& sites,
                       const std::vector<PlannedImplant>& implants) {
  if (!sites_.empty() || phase_ == Phase::refused) return;
  if (sites.empty()) return refuse("the plan has no sites");
  for (const ToolPose& site : sites) {
    const auto valid = checked(site, fmt::format("site {}'s", sites_.size() + 1));
    if (!valid) return refuse("the plan: " + valid.error().text);
    sites_.emplace_back(Eigen::Translation3d{valid->position} *
                        std::get<Eigen::Quaterniond>(valid->orientation));
  }
  if (implants.empty()) return;
  if (const auto wrong = defect(implants, sites.size(), parameters_.depth)) {
    return refuse("the plan: " + *wrong);
  }
  if (phase_ != Phase::pivoting) {
    return refuse("the plan with implants came when the driver's tip could not be found any more");
  }
  implants_ = implants;
}

void Implant::see_arm(const Isometry3d& base_T_flange) {
  base_T_flange_ = base_T_flange;
  if (at_sites()) rounds_[round_].bottoms.see(base_T_flange);
}

void Implant::see_drill_in_hand(const Sighting& sighting) {
  if (phase_ == Phase::pivoting && !drill_tip_) drill_.see(sighting);
}

void Implant::see_driver_in_hand(const Sighting& sighting) {
  if (phase_ == Phase::pivoting && drill_tip_) driver_.see(sighting);
}

void Implant::see_flange(const Sighting& sighting) {
  flange_watch_.see(sighting);
  if (phase_ == Phase::calibrating && base_T_flange_) calibration_.see(sighting, *base_T_flange_);
}

void Implant::see_jaw(const Sighting& sighting) {
  jaw_watch_.see(sighting);
  if (!sighting.tracker_T_body) return;
  if (phase_ == Phase::locating) {
    if (const auto moved = jaw_.see(*sighting.tracker_T_body)) refuse(*moved);
  } else if (phase_ == Phase::approaching || at_sites()) {
    if (const auto moved = jaw_.guard(*sighting.tracker_T_body)) refuse(*moved);
  }
}

void Implant::hear(const GoalReport& report, Time now) {
  goal_.hear(report, now);
  const bool there = goal_.state() == PursuedGoal::State::done;
  const bool failed = goal_.state() == PursuedGoal::State::failed;
  if (turned_ && (there || failed)) return come_back(now);
  if (phase_ == Phase::calibrating && sent_to_ == calibration_.number()) {
    if (there) calibration_.arrive(goal_.done_at());
    // Or it would go on with the poses that it has, and move once somebody rearms the arm.
    if (failed && goal_.stopped()) return refuse("hand-eye: " + goal_.reason());
    if (failed) calibration_.leave_out(goal_.reason());
  }
  const bool above = phase_ == Phase::approaching, out = phase_ == Phase::withdrawing;
  if (!set_out_ || !(above || out || at_sites())) return;
  if (failed) {
    return refuse((above ? "above site 1"
                   : out ? "withdrawal"
                         : pass().name) +
                  ": " + goal_.reason());
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
  if (base_T_flange_) {
    const auto wrong = thread_watch_.trouble(tool(), now);
    if (wrong) return refuse(pass().name + ": " + *wrong);
  }
  const bool watches_the_jaw = phase_ == Phase::approaching || at_sites();
  if (procedure_.paused() && !watches_the_jaw) return;
  switch (phase_) {
    case Phase::pivoting:
      if ((drill_tip_ ? driver_ : drill_).complete(now)) return finish_pivot(now);
      if (const auto blind = (drill_tip_ ? driver_ : drill_).blind(now)) refuse("pivot: " + *blind);
      break;
    case Phase::calibrating:
      calibration_.update(now);
      if (!calibration_.trouble().empty()) return refuse("hand-eye: " + calibration_.trouble());
      if (!calibration_.destination()) return finish_calibration(now);
      go_on_calibrating();
      break;
    case Phase::locating:
      if (jaw_.located()) return finish_locating(now);
      if (const auto blind = jaw_watch_.blind(now)) refuse(*blind);
      break;
    case Phase::approaching:
    case Phase::drilling:
    case Phase::placing:
      if (const auto blind = jaw_watch_.blind(now)) return refuse(*blind);
      if (const auto blind = flange_watch_.blind(now)) return refuse(*blind);
      if (!set_out_) return set_out(now);
      if (at_sites() && procedure_.may_act()) go_on(now);
      break;
    case Phase::withdrawing:
      if (!set_out_) set_out(now);
      break;
    case Phase::changing_tool:
      // Not at once: whoever watches is told of it.
      if (procedure_.may_act() && now > out_at_) enter_approach(now);
      break;
    case Phase::going_back:
    case Phase::aborting:
      if (!turned_ && goal_.state() != PursuedGoal::State::pausing) turn_back();
      break;
    case Phase::registering:
    case Phase::drilled:
    case Phase::placed:
    case Phase::held:
    case Phase::aborted:
    case Phase::refused:
      break;
  }
}

/// Of the drill, and then of the driver where there are implants.
void Implant::finish_pivot(Time now) {
  const bool of_driver = drill_tip_.has_value();
  const PivotRun& run = of_driver ? driver_ : drill_;
  const auto pivot = run.result();
  const char* tool = of_driver ? "driver" : "pivot";
  if (!pivot) return refuse(fmt::format("{}: {}", tool, pivot.error().text));
  news_.push_back(fmt::format(
      "{}: {} poses, the tip stood still to {:.2f} mm and is known to {:.2f} mm (95 %)", tool,
      run.poses(), 1e3 * pivot->residual_rms_m, 1e3 * pivot->tip_error.bound95_m));
  (of_driver ? driver_tip_ : drill_tip_) = *pivot;
  if (!of_driver) {
    chain_.tip = pivot->tip;
    if (!implants_.empty()) {
      news_.push_back("pivot: waits for the driver, turned about its tip");
      return;
    }
  } else if (!thread_watch_.heard_of()) {
    return refuse("the plan has implants, and no handpiece tells how far it turns them");
  }
  enter(Phase::calibrating, now);
  procedure_.enter(kCalibration);
}

void Implant::go_on_calibrating() {
  if (sent_to_ == calibration_.number()) return;
  sent_to_ = calibration_.number();
  goal_.set({.pose = *calibration_.destination(), .focus = {}});
}

void Implant::finish_calibration(Time now) {
  const auto found = calibrate_hand_eye(calibration_.poses());
  if (!found) return refuse("hand-eye: " + found.error().text);
  if (found->residual_rms_m > parameters_.max_hand_eye_rms) {
    return refuse(fmt::format("hand-eye: the poses fit to {:.2f} mm rms, {:g} mm are allowed",
                              1e3 * found->residual_rms_m, 1e3 * parameters_.max_hand_eye_rms));
  }
  hand_eye_ = *found;
  chain_.flange_T_body = hand_eye_.flange_T_body;
  chain_.base_T_tracker = hand_eye_.base_T_tracker;
  std::string line =
      fmt::format("hand-eye: {} of {} poses fit to {:.2f} mm", calibration_.poses().size(),
                  calibration_.count(), 1e3 * hand_eye_.residual_rms_m);
  if (!calibration_.left_out().empty()) line += "; left out: " + calibration_.left_out();
  news_.push_back(line);
  enter(Phase::registering, now);
  procedure_.enter(kRegistration);
}

void Implant::see_registration(const RegisteredJaw& jaw, Time now) {
  if (phase_ != Phase::registering) return;
  if (jaw.sites.size() != sites_.size()) {
    return refuse(fmt::format("the registration tells the error of {} sites, the plan has {}",
                              jaw.sites.size(), sites_.size()));
  }
  if (!(jaw.fiducial_error_m <= parameters_.max_fre)) {
    return refuse(fmt::format("the markers fit to {:.2f} mm rms, {:g} mm are allowed",
                              1e3 * jaw.fiducial_error_m, 1e3 * parameters_.max_fre));
  }
  news_.push_back(
      fmt::format("registration: the markers fit to {:.2f} mm", 1e3 * jaw.fiducial_error_m));
  registered_ = jaw;
  chain_.patient_T_image = jaw.jaw_T_image;
  std::vector<Eigen::Vector3d> ends;
  for (const Isometry3d& site : sites_) {
    for (const double above_m : {0.0, parameters_.depth}) {
      ends.emplace_back(chain_.patient_T_image * (site * Eigen::Vector3d{0, 0, -above_m}));
    }
  }
  jaw_.locate(std::move(ends));
  enter(Phase::locating, now);
}

void Implant::finish_locating(Time now) {
  chain_.tracker_T_patient = jaw_.average().mean();
  auto drilling = forecast(std::vector(sites_.size(), chain_), *drill_tip_, "site");
  if (!drilling) return refuse(drilling.error().text);
  forecasts_ = std::move(*drilling);
  if (driver_tip_) {
    std::vector<GuidedChain> ends;
    for (const PlannedImplant& implant : implants_) {
      ends.push_back(with_implant(*driver_chain(), implant));
    }
    const auto placing = forecast(ends, *driver_tip_, "implant");
    if (!placing) return refuse(placing.error().text);
  }
  plan_rounds();
  if (base_T_flange_ && !came_from_) {
    const Isometry3d at = *base_T_flange_ * flange_T_file_tool_;
    came_from_ = {at.translation(), Eigen::Quaterniond{at.linear()}.normalized()};
  }
  enter_approach(now);
}

Expected<std::vector<ErrorForecast>> Implant::forecast(const std::vector<GuidedChain>& chains,
                                                       const Pivot& pivot, const char* tool) {
  std::vector<ErrorForecast> forecasts;
  double worst_m = 0;
  for (std::size_t i = 0; i < sites_.size(); ++i) {
    forecasts.push_back(
        forecast_at(sites_[i], chains[i], pivot, hand_eye_, jaw_.average(), registered_.sites[i]));
    const double bound_m = forecasts.back().bound95_m();
    worst_m = std::max(worst_m, bound_m);
    if (!(bound_m <= parameters_.max_tre)) {
      return armature::refuse(
          fmt::format("{} {} is known to {:.2f} mm (95 %), {:g} mm are required", tool, i + 1,
                      1e3 * bound_m, 1e3 * parameters_.max_tre));
    }
  }
  news_.push_back(fmt::format("the worst of {} {}s is known to {:.2f} mm (95 %)", sites_.size(),
                              tool, 1e3 * worst_m));
  return forecasts;
}

std::optional<GuidedChain> Implant::driver_chain() const {
  if (!driver_tip_) return std::nullopt;
  GuidedChain chain = chain_;
  chain.tip = driver_tip_->tip;
  return chain;
}

void Implant::plan_rounds() {
  rounds_.clear();
  std::vector<Destination> bottoms;
  for (const Isometry3d& site : sites_) bottoms.push_back(destination(chain_, site));
  rounds_.push_back({.way = drilling_way(chain_, flange_T_file_tool_, sites_, parameters_),
                     .bottoms = {bottoms, "the drill", "the bottom of"}});
  if (driver_tip_) {
    const GuidedChain driver = *driver_chain();
    bottoms.clear();
    for (std::size_t i = 0; i < sites_.size(); ++i) {
      bottoms.push_back(
          destination(with_implant(driver, implants_[i]), place_of(sites_[i], implants_[i])));
    }
    rounds_.push_back(
        {.way = placing_way(driver, flange_T_file_tool_, sites_, implants_, parameters_),
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
  set_out_ = false;
  enter(Phase::approaching, now);
  procedure_.enter(rounds_[round_].approach);
  set_out(now);
}

void Implant::set_out(Time now) {
  if (!procedure_.may_act()) return;
  set_out_ = true;
  const SiteWay& way = rounds_[round_].way;
  switch (phase_) {
    case Phase::approaching:
      return goal_.set_once({.pose = way.above.front()});
    case Phase::withdrawing:
      homing_ = false;
      return lead_out();
    default:
      if (pass().turns) {
        const Isometry3d site = chain_.base_T_site(sites_[pass().site]);
        thread_watch_.engage({.start = way.passes[pass_ - 1].goal.pose.position,
                              .axis = site.linear().col(2),
                              .pitch_m = implants_[pass().site].pitch_m},
                             now);
      }
      return goal_.set_once(pass().goal);
  }
}

void Implant::come_to_pass(std::size_t pass, Time now) {
  enter(placing() ? Phase::placing : Phase::drilling, now);
  thread_watch_.release();
  pass_ = pass;
  set_out_ = false;
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
  withdraw(now);
}

void Implant::withdraw(Time now) {
  set_out_ = false;
  enter(Phase::withdrawing, now);
  procedure_.enter(rounds_[round_].withdrawal);
  set_out(now);
}

void Implant::finish_round(Time now) {
  if (round_ + 1 == rounds_.size()) {
    enter(placing() ? Phase::placed : Phase::drilled, now);
    return procedure_.end();
  }
  out_at_ = now;
  ++round_;
  pass_ = 0;
  set_out_ = false;
  enter(Phase::changing_tool, now);
  procedure_.enter(rounds_[round_].approach - 1);
}

bool Implant::near_the_jaw() const {
  switch (phase_) {
    case Phase::approaching:
      return set_out_;
    case Phase::drilling:
    case Phase::placing:
    case Phase::withdrawing:
    case Phase::going_back:
    case Phase::held:
    case Phase::aborting:
      return true;
    default:
      return false;
  }
}

void Implant::refuse(const std::string& why) {
  if (phase_ == Phase::refused || phase_ == Phase::held) return;
  const bool held = near_the_jaw() && !procedure_.auto_confirm();
  phase_ = held ? Phase::held : Phase::refused;
  turned_ = false;
  trouble_ = why;
  if (held) {
    procedure_.turn_back();
  } else {
    procedure_.end(Procedure::StepState::broken_off);
  }
  const bool on_its_way =
      goal_.state() == PursuedGoal::State::waiting || goal_.state() == PursuedGoal::State::moving;
  if (on_its_way) goal_.set({.mode = MotionMode::hold, .pose = {}, .focus = {}});
}

std::vector<std::string> Implant::take_news() { return std::exchange(news_, {}); }

const char* to_string(Implant::Phase phase) {
  switch (phase) {
    case Implant::Phase::pivoting:
      return "pivoting";
    case Implant::Phase::calibrating:
      return "calibrating";
    case Implant::Phase::registering:
      return "registering";
    case Implant::Phase::locating:
      return "locating";
    case Implant::Phase::approaching:
      return "approaching";
    case Implant::Phase::drilling:
      return "drilling";
    case Implant::Phase::placing:
      return "placing";
    case Implant::Phase::withdrawing:
      return "withdrawing";
    case Implant::Phase::changing_tool:
      return "changing tool";
    case Implant::Phase::drilled:
      return "drilled";
    case Implant::Phase::placed:
      return "placed";
    case Implant::Phase::going_back:
      return "going back";
    case Implant::Phase::held:
      return "held";
    case Implant::Phase::aborting:
      return "aborting";
    case Implant::Phase::aborted:
      return "aborted";
    case Implant::Phase::refused:
      return "refused";
  }
  return "";
}

}  // namespace armature::task::implant
