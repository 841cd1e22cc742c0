// SPDX-License-Identifier: Apache-2.0
#include "implant.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

namespace armature::task::implant {
namespace {

using Eigen::Isometry3d;

constexpr int kJawSamples = 10;  // one by itself errs too much far from the body

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
      drill_watch_{"the drill in the hand", seconds(parameters.timeout)},
      flange_watch_{"the flange", seconds(parameters.timeout)},
      jaw_watch_{"the jaw", seconds(parameters.timeout)} {
  chain_.flange_R_tool = flange_T_file_tool.linear();
}

void Implant::begin(Time now) { enter(Phase::pivoting, now); }

void Implant::enter(Phase phase, Time now) {
  phase_ = phase;
  if (phase == Phase::pivoting) drill_watch_.begin(now);
  if (phase == Phase::locating || phase == Phase::approaching) jaw_watch_.begin(now);
  if (phase == Phase::approaching) flange_watch_.begin(now);
}

void Implant::see_plan(const std::vector<ToolPose>& sites) {
  if (!sites_.empty() || phase_ == Phase::refused) return;
  if (sites.empty()) return refuse("the plan has no sites");
  for (const ToolPose& site : sites) {
    const auto valid = checked(site, fmt::format("site {}'s", sites_.size() + 1));
    if (!valid) return refuse("the plan: " + valid.error().text);
    sites_.emplace_back(Eigen::Translation3d{valid->position} *
                        std::get<Eigen::Quaterniond>(valid->orientation));
  }
}

void Implant::see_arm(const Isometry3d& base_T_flange) {
  base_T_flange_ = base_T_flange;
  if (phase_ == Phase::drilling) bottoms_.see(base_T_flange);
}

void Implant::see_pivot(const Sighting& sighting) {
  if (phase_ != Phase::pivoting) return;
  drill_watch_.see(sighting);
  if (!sighting.tracker_T_body) return;
  if (!pivot_since_) pivot_since_ = sighting.stamp;
  pivot_poses_.push_back(*sighting.tracker_T_body);
}

void Implant::see_flange(const Sighting& sighting) {
  flange_watch_.see(sighting);
  if (phase_ == Phase::calibrating && base_T_flange_) calibration_.see(sighting, *base_T_flange_);
}

void Implant::see_jaw(const Sighting& sighting) {
  jaw_watch_.see(sighting);
  if (!sighting.tracker_T_body) return;
  if (phase_ == Phase::locating) locate_jaw(*sighting.tracker_T_body);
  if (phase_ != Phase::approaching && phase_ != Phase::drilling) return;
  jaw_now_.add(*sighting.tracker_T_body);
  if (jaw_now_.count() == kJawSamples) guard_jaw();
}

int Implant::jaw_block() const { return std::clamp(parameters_.jaw_samples / 2, 1, kJawSamples); }

double Implant::max_moved(const Isometry3d& tracker_T_jaw, const Isometry3d& from) const {
  double max_m = 0;
  for (const Isometry3d& site : sites_) {
    for (const double above_m : {0.0, parameters_.depth}) {
      const Eigen::Vector3d point =
          chain_.patient_T_image * (site * Eigen::Vector3d{0, 0, -above_m});
      max_m = std::max(max_m, (tracker_T_jaw * point - from * point).norm());
    }
  }
  return max_m;
}

/// A jaw that moves meanwhile is no noise, which a mean would take down.
void Implant::locate_jaw(const Isometry3d& tracker_T_jaw) {
  jaw_.add(tracker_T_jaw);
  jaw_now_.add(tracker_T_jaw);
  if (jaw_now_.count() < jaw_block()) return;
  const Isometry3d now = jaw_now_.mean();
  jaw_now_.clear();
  if (!jaw_first_) jaw_first_ = now;
  const double moved_m = max_moved(now, *jaw_first_);
  if (moved_m <= parameters_.max_jaw_motion) return;
  refuse(fmt::format("the jaw moved by {:.2f} mm while its place was averaged, {:g} mm are allowed",
                     1e3 * moved_m, 1e3 * parameters_.max_jaw_motion));
}

/// Against where the jaw was when the way was worked out.
void Implant::guard_jaw() {
  const double moved_m = max_moved(jaw_now_.mean(), chain_.tracker_T_patient);
  jaw_now_.clear();
  if (moved_m <= parameters_.max_jaw_motion) return;
  refuse(fmt::format("the jaw has moved by {:.2f} mm, {:g} mm are allowed", 1e3 * moved_m,
                     1e3 * parameters_.max_jaw_motion));
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
  if ((phase_ != Phase::approaching && phase_ != Phase::drilling) || !set_out_) return;
  if (failed) {
    const bool above = phase_ == Phase::approaching;
    return refuse((above ? "above site 1" : way_.bores[bore_].name) + ": " + goal_.reason());
  }
  if (!there || phase_ == Phase::drilling) return;
  come_to_bore(0, now);
}

void Implant::update(Time now) {
  const bool near_the_jaw = phase_ == Phase::approaching || phase_ == Phase::drilling;
  if (procedure_.paused() && !near_the_jaw) return;
  switch (phase_) {
    case Phase::pivoting:
      if (pivot_since_ && now - *pivot_since_ >= seconds(parameters_.pivot)) {
        return finish_pivot(now);
      }
      if (const auto blind = drill_watch_.blind(now)) refuse("pivot: " + *blind);
      break;
    case Phase::calibrating:
      calibration_.update(now);
      if (!calibration_.trouble().empty()) return refuse("hand-eye: " + calibration_.trouble());
      if (!calibration_.destination()) return finish_calibration(now);
      go_on_calibrating();
      break;
    case Phase::locating:
      if (jaw_.count() >= parameters_.jaw_samples) return finish_locating(now);
      if (const auto blind = jaw_watch_.blind(now)) refuse(*blind);
      break;
    case Phase::approaching:
    case Phase::drilling:
      if (const auto blind = jaw_watch_.blind(now)) return refuse(*blind);
      if (const auto blind = flange_watch_.blind(now)) return refuse(*blind);
      if (!set_out_) return set_out();
      if (phase_ == Phase::drilling && procedure_.may_act()) go_on_drilling(now);
      break;
    case Phase::going_back:
    case Phase::aborting:
      if (!turned_ && goal_.state() != PursuedGoal::State::pausing) turn_back();
      break;
    case Phase::registering:
    case Phase::drilled:
    case Phase::aborted:
    case Phase::refused:
      break;
  }
}

void Implant::finish_pivot(Time now) {
  const auto pivot = calibrate_pivot(pivot_poses_);
  if (!pivot) return refuse("pivot: " + pivot.error().text);
  if (pivot->residual_rms_m > parameters_.max_pivot_rms) {
    return refuse(fmt::format("pivot: the tip stood still to {:.2f} mm rms, {:g} mm are allowed",
                              1e3 * pivot->residual_rms_m, 1e3 * parameters_.max_pivot_rms));
  }
  pivot_ = *pivot;
  chain_.tip = pivot_.tip;
  news_.push_back(fmt::format(
      "pivot: {} poses, the tip stood still to {:.2f} mm and is known to "
      "{:.2f} mm (95 %)",
      pivot_poses_.size(), 1e3 * pivot_.residual_rms_m, 1e3 * pivot_.tip_error.bound95_m));
  enter(Phase::calibrating, now);
  enter_step(Step::calibration);
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
  enter_step(Step::registration);
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
  enter(Phase::locating, now);
}

void Implant::finish_locating(Time now) {
  chain_.tracker_T_patient = jaw_.mean();
  jaw_now_.clear();
  double worst_m = 0;
  for (std::size_t i = 0; i < sites_.size(); ++i) {
    const ErrorForecast& forecast = forecasts_.emplace_back(
        forecast_at(sites_[i], chain_, pivot_, hand_eye_, jaw_, registered_.sites[i]));
    worst_m = std::max(worst_m, forecast.bound95_m());
    if (!(forecast.bound95_m() <= parameters_.max_tre)) {
      return refuse(fmt::format("site {} is known to {:.2f} mm (95 %), {:g} mm are required", i + 1,
                                1e3 * forecast.bound95_m(), 1e3 * parameters_.max_tre));
    }
  }
  news_.push_back(fmt::format("the worst of {} sites is known to {:.2f} mm (95 %)", sites_.size(),
                              1e3 * worst_m));
  way_ = drilling_way(chain_, flange_T_file_tool_, sites_, parameters_);
  bottoms_ = BottomWatch{chain_, sites_};
  std::vector<Procedure::Step> ahead{procedure_.steps()[static_cast<std::size_t>(Step::approach)]};
  for (const Bore& bore : way_.bores) {
    if (bore.ends_at_bottom) ahead.push_back({.name = bore.name, .asks = true});
  }
  if (ahead.size() == 1) ahead.push_back({.name = "drilling", .asks = true});
  procedure_.set_steps_ahead(ahead);
  if (base_T_flange_ && !came_from_) {
    const Isometry3d tool = *base_T_flange_ * flange_T_file_tool_;
    came_from_ = {tool.translation(), Eigen::Quaterniond{tool.linear()}.normalized()};
  }
  set_out_ = false;
  enter(Phase::approaching, now);
  enter_step(Step::approach);
  set_out();
}

void Implant::set_out() {
  if (!procedure_.may_act()) return;
  set_out_ = true;
  goal_.set_once(phase_ == Phase::approaching ? MotionGoal{.pose = way_.above.front()}
                                              : way_.bores[bore_].goal);
}

void Implant::come_to_bore(std::size_t bore, Time now) {
  enter(Phase::drilling, now);
  bore_ = bore;
  set_out_ = false;
  const auto first = static_cast<std::size_t>(Step::first_site);
  const bool each_asks = way_.bores.size() > 1;
  const std::size_t step = first + (each_asks ? way_.bores[bore].first_site : 0);
  const bool comes_out = bore > 0 && !way_.bores[bore].ends_at_bottom;
  if (!comes_out) procedure_.enter(step);
  set_out();
}

Expected<void> Implant::hear(const OperatorCommand& command, Time now) {
  const auto word = procedure_.hear(command);
  if (!word) return tl::unexpected{word.error()};
  switch (*word) {
    case OperatorWord::confirm:
      break;
    case OperatorWord::pause:
      goal_.pause();
      break;
    case OperatorWord::resume:
      goal_.resume();
      break;
    case OperatorWord::back:
      return go_back(now);
    case OperatorWord::abort:
      return abort();
  }
  return {};
}

/// From a bore out of the bone, where its step asks again; from above the first site, and before,
/// to the registration.
Expected<void> Implant::go_back(Time now) {
  if (phase_ == Phase::going_back || phase_ == Phase::aborting) {
    return armature::refuse("the drill goes back already");
  }
  if (phase_ != Phase::approaching && phase_ != Phase::drilling) {
    return armature::refuse("before the approach there is no step to go back to");
  }
  procedure_.turn_back();
  goal_.pause();
  if (phase_ == Phase::approaching || (bore_ == 0 && !set_out_)) {
    register_again(now);
  } else if (!set_out_) {
    come_to_bore(bore_ - 2, now);  // into the site before
  } else {
    phase_ = Phase::going_back;
    turned_ = false;
  }
  return {};
}

void Implant::register_again(Time now) {
  jaw_.clear();
  jaw_now_.clear();
  jaw_first_.reset();
  forecasts_.clear();
  enter(Phase::registering, now);
  enter_step(Step::registration);
}

/// Out of the bone, over the sites, and to where the approach began.
Expected<void> Implant::abort() {
  if (phase_ == Phase::aborting) return armature::refuse("it is being aborted already");
  procedure_.turn_back();
  const bool left = phase_ == Phase::drilling || phase_ == Phase::going_back ||
                    (phase_ == Phase::approaching && set_out_);
  if (left) {
    if (!turned_ || phase_ != Phase::going_back) goal_.pause();
    set_out_ = set_out_ || phase_ != Phase::approaching;
    phase_ = Phase::aborting;
    turned_ = false;
    return {};
  }
  goal_.pause();
  phase_ = Phase::aborted;
  procedure_.end(Procedure::StepState::broken_off);
  return {};
}

void Implant::turn_back() {
  if (procedure_.paused() || !base_T_flange_) return;
  turned_ = true;
  const bool approached = procedure_.step() > static_cast<std::size_t>(Step::approach);
  if (!approached) return goal_.retrace(false);
  const Eigen::Vector3d tool = (*base_T_flange_ * flange_T_file_tool_).translation();
  const std::size_t site = way_.bores[bore_].first_site;
  goal_.set_once(phase_ == Phase::aborting ? way_out(way_, tool, 0, came_from_)
                                           : way_out(way_, tool, site));
}

void Implant::come_back(Time now) {
  turned_ = false;
  if (goal_.state() == PursuedGoal::State::failed) {
    return refuse("the way back: " + goal_.reason());
  }
  if (phase_ == Phase::aborting) {
    phase_ = Phase::aborted;
    return procedure_.end(Procedure::StepState::broken_off);
  }
  const std::size_t site = way_.bores[bore_].first_site;
  come_to_bore(way_.bores.size() > 1 ? 2 * site : 0, now);
}

void Implant::go_on_drilling(Time now) {
  if (goal_.state() != PursuedGoal::State::done) return;
  if (way_.bores[bore_].ends_at_bottom && now - goal_.done_at() < seconds(parameters_.dwell)) {
    return;
  }
  const auto missed = bottoms_.missed(way_.bores[bore_].sites, parameters_.max_bottom_error);
  if (missed) return refuse(*missed);
  if (bore_ + 1 < way_.bores.size()) return come_to_bore(bore_ + 1, now);
  enter(Phase::drilled, now);
  procedure_.end();
}

void Implant::refuse(const std::string& why) {
  if (phase_ == Phase::refused) return;
  phase_ = Phase::refused;
  trouble_ = why;
  procedure_.end(Procedure::StepState::broken_off);
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
    case Implant::Phase::drilled:
      return "drilled";
    case Implant::Phase::going_back:
      return "going back";
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
