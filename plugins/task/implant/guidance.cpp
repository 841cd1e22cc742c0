// SPDX-License-Identifier: Apache-2.0
#include "guidance.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

namespace armature::task::implant {

using Eigen::Isometry3d;

namespace {

constexpr int kFlangeSamples = 10;          // as of the jaw: one by itself errs too much at the tip
constexpr Duration kRested = seconds(1.0);  // since then it is another motion

}  // namespace

Guidance::Guidance(const Parameters& parameters, const RobotModel& robot,
                   const Eigen::Matrix3d& flange_R_tool)
    : parameters_{parameters},
      drill_{parameters, "the drill"},
      driver_{parameters, "the driver"},
      calibration_{parameters, robot},
      flange_watch_{"the flange", seconds(parameters.timeout)},
      jaw_watch_{"the jaw", seconds(parameters.timeout)},
      jaw_{parameters},
      flange_{parameters} {
  chain_.flange_R_tool = flange_R_tool;
}

Expected<void> Guidance::see_plan(const std::vector<ToolPose>& sites,
                                  const std::vector<PlannedImplant>& implants) {
  if (!sites_.empty()) return {};
  if (sites.empty()) return refuse("the plan has no sites");
  for (const ToolPose& site : sites) {
    const auto valid = checked(site, fmt::format("site {}'s", sites_.size() + 1));
    if (!valid) return refuse("the plan: " + valid.error().text);
    sites_.emplace_back(Eigen::Translation3d{valid->position} *
                        std::get<Eigen::Quaterniond>(valid->orientation));
  }
  if (const auto wrong = defect(sites_, parameters_)) return refuse("the plan: " + *wrong);
  if (implants.empty()) return {};
  if (const auto wrong = defect(implants, sites_, parameters_)) {
    return refuse("the plan: " + *wrong);
  }
  if (step_ != Step::pivot) {
    return refuse("the plan with implants came when the driver's tip could not be found any more");
  }
  implants_ = implants;
  return {};
}

void Guidance::see_drill_in_hand(const Sighting& sighting) {
  if (step_ == Step::pivot && !drill_tip_) drill_.see(sighting);
}

void Guidance::see_driver_in_hand(const Sighting& sighting) {
  if (step_ == Step::pivot && drill_tip_) driver_.see(sighting);
}

Expected<void> Guidance::see_flange(const Sighting& sighting,
                                    const std::optional<Isometry3d>& base_T_flange, bool must_agree,
                                    Time now) {
  const Stillness still = arm_noise_.stillness();
  const bool rests = !base_T_flange || !still.is_left(flange_seen_at_, *base_T_flange);
  if (!rests) {
    if (now - std::exchange(moved_at_, now) > kRested) restless_since_ = now;
    const Isometry3d from = std::exchange(flange_seen_at_, *base_T_flange);
    if (step_ == Step::place && now - restless_since_ > kRestsWithin) {
      return refuse(restless(from, flange_seen_at_));
    }
  }
  const bool anew = flange_watch_.see(sighting, rests);
  if (!base_T_flange) return {};
  if (step_ == Step::hand_eye) calibration_.see(sighting, *base_T_flange, still);
  if (!anew) return {};
  if (step_ == Step::place) flange_.see(sighting, *base_T_flange, now, still);
  if (step_ != Step::complete || !must_agree) return {};
  flange_.see(sighting, *base_T_flange, now, still);
  if (flange_.samples() < kFlangeSamples) return {};
  const auto agrees = check_flange(false);
  flange_.forget();
  return agrees;
}

Expected<void> Guidance::check_flange(bool at_bores) const {
  std::vector<Eigen::Vector3d> points{flange_.base_T_body() * chain_.tip};
  if (at_bores) {
    const Isometry3d base_T_jaw = chain_.base_T_tracker * jaw_.average().mean();
    for (const Eigen::Vector3d& end : jaw_.ends()) points.push_back(base_T_jaw * end);
  }
  if (const auto wrong = flange_.defect(points)) return refuse(*wrong);
  return {};
}

/// While the jaw is located.
int Guidance::flange_samples() const { return std::min(kFlangeSamples, parameters_.jaw_samples); }

Expected<void> Guidance::see_jaw(const Sighting& sighting, bool must_rest) {
  if (!jaw_watch_.see(sighting)) return {};
  std::optional<std::string> moved;
  if (step_ == Step::place) {
    moved = jaw_.see(*sighting.tracker_T_body);
  } else if (must_rest) {
    moved = jaw_.guard(*sighting.tracker_T_body);
  }
  if (moved) return refuse(*moved);
  return {};
}

Expected<void> Guidance::see_registration(const RegisteredJaw& jaw, Time now) {
  if (step_ != Step::registration) return {};
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
  flange_.forget();
  begin_to_guard(now);
  restless_since_ = now;
  step_ = Step::place;
  return {};
}

Expected<void> Guidance::update(Time now) {
  switch (step_) {
    case Step::pivot: {
      PivotRun& run = drill_tip_ ? driver_ : drill_;
      if (run.complete(now)) return finish_pivot();
      if (const auto blind = run.blind(now)) return refuse("pivot: " + *blind);
      return {};
    }
    case Step::hand_eye:
      calibration_.update(now);
      if (!calibration_.trouble().empty()) return refuse("hand-eye: " + calibration_.trouble());
      if (!calibration_.destination()) return finish_hand_eye();
      return {};
    case Step::place:
      if (jaw_.located() && flange_.samples() >= flange_samples()) return finish_place();
      return guard(now);
    case Step::registration:
    case Step::complete: return {};
  }
  return {};
}

/// Of the drill, and then of the driver where there are implants.
Expected<void> Guidance::finish_pivot() {
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
      return {};
    }
  } else if (!has_handpiece_) {
    return refuse("the plan has implants, and no handpiece tells how far it turns them");
  }
  step_ = Step::hand_eye;
  return {};
}

Expected<void> Guidance::finish_hand_eye() {
  const auto found = calibrate_hand_eye(calibration_.poses());
  if (!found) return refuse("hand-eye: " + found.error().text);
  if (found->residual_rms_m > parameters_.max_hand_eye_rms) {
    return refuse(fmt::format("hand-eye: the poses fit to {:.2f} mm rms, {:g} mm are allowed",
                              1e3 * found->residual_rms_m, 1e3 * parameters_.max_hand_eye_rms));
  }
  hand_eye_ = *found;
  flange_.calibrate(hand_eye_);
  chain_.flange_T_body = hand_eye_.flange_T_body;
  chain_.base_T_tracker = hand_eye_.base_T_tracker;
  std::string line =
      fmt::format("hand-eye: {} of {} poses fit to {:.2f} mm", calibration_.poses().size(),
                  calibration_.count(), 1e3 * hand_eye_.residual_rms_m);
  if (!calibration_.left_out().empty()) line += "; left out: " + calibration_.left_out();
  news_.push_back(line);
  step_ = Step::registration;
  return {};
}

Expected<void> Guidance::finish_place() {
  const auto agrees = check_flange(true);
  flange_.forget();
  if (!agrees) return agrees;
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
  step_ = Step::complete;
  return {};
}

Expected<std::vector<ErrorForecast>> Guidance::forecast(const std::vector<GuidedChain>& chains,
                                                        const Pivot& pivot, const char* tool) {
  std::vector<ErrorForecast> forecasts;
  double worst_m = 0;
  for (std::size_t i = 0; i < sites_.size(); ++i) {
    forecasts.push_back(
        forecast_at(sites_[i], chains[i], pivot, hand_eye_, jaw_.average(), registered_.sites[i]));
    const double bound_m = forecasts.back().bound95_m();
    worst_m = std::max(worst_m, bound_m);
    if (!(bound_m <= parameters_.max_tre)) {
      return refuse(fmt::format("{} {} is known to {:.2f} mm (95 %), {:g} mm are required", tool,
                                i + 1, 1e3 * bound_m, 1e3 * parameters_.max_tre));
    }
  }
  news_.push_back(fmt::format("the worst of {} {}s is known to {:.2f} mm (95 %)", sites_.size(),
                              tool, 1e3 * worst_m));
  return forecasts;
}

void Guidance::register_again(const std::string& why) {
  if (!why.empty()) news_.push_back(why + ": it is registered again");
  forecasts_.clear();
  step_ = Step::registration;
}

void Guidance::begin_to_guard(Time now) {
  jaw_watch_.begin(now);
  flange_watch_.begin(now);
}

Expected<void> Guidance::guard(Time now) const {
  if (const auto blind = jaw_watch_.blind(now)) return refuse(*blind);
  if (const auto blind = flange_watch_.blind(now)) return refuse(*blind);
  return {};
}

std::vector<std::string> Guidance::take_news() { return std::exchange(news_, {}); }

std::optional<GuidedChain> Guidance::driver_chain() const {
  if (!driver_tip_) return std::nullopt;
  GuidedChain chain = chain_;
  chain.tip = driver_tip_->tip;
  return chain;
}

}  // namespace armature::task::implant
