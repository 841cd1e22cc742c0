// SPDX-License-Identifier: Apache-2.0
#include "armature/motion/arm_following.hpp"

#include <utility>

#include "armature/motion/tip_bound.hpp"

namespace armature {
namespace {

constexpr double kStill = 1e-3;  // [rad/s] or [m/s] that an arm tells of itself

constexpr std::string_view kFollows =
    "the arm says that it follows, so the reference stays: look at its encoders, its load and what "
    "holds it";
constexpr std::string_view kGoesAlong =
    "the arm goes along when the reference comes to it, so the reference stays: look at the arm's "
    "encoders and load";

bool tells_rest(const MeasuredJoints& measured) {
  return measured.v.size() > 0 && measured.v.isZero(kStill);
}

}  // namespace

ArmFollowing::ArmFollowing(const RobotModel& model, const MotionLimits& limits,
                           const FollowingOptions& options, Reference& reference)
    : model_{model},
      options_{options},
      reference_{reference},
      rest_{each(options.rest_tolerance, model)},
      return_{model, limits, each(options.rest_tolerance, model)} {}

bool ArmFollowing::comes_late(Time now) {
  const Duration late = stepped_at_ ? now - *stepped_at_ - options_.period : Duration{0};
  stepped_at_ = now;
  if (late <= options_.max_lateness || !reference_.started()) return false;
  trouble_ = ReasonText::format("motion itself came {:.2f} s late (max_lateness_s is {:g})",
                                to_seconds(late), to_seconds(options_.max_lateness));
  reference_.forget();
  measured_.reset();  // nor may a rearm begin from where the arm was
  rest_.forget();
  return_.forget();
  begin_after_ = now;
  astray_ = false;
  return true;
}

void ArmFollowing::begin(Time now, const std::optional<MeasuredJoints>& measured) {
  if (!silence(now, measured).empty() || measured->stamp < begin_after_) return;
  measured_ = measured;
  rest_.see(measured->q, measured->stamp);
  const bool is_first = begin_after_ == Time{};
  if (!rest_.rests() && !(is_first && tells_rest(*measured))) {
    if (is_first) trouble_ = "the arm moves already; motion begins where it rests";
    return;
  }
  reference_.start(measured->q, now);
  trouble_.clear();
}

ReasonText ArmFollowing::silence(Time now, const std::optional<MeasuredJoints>& measured) const {
  if (!measured) return "no joint state of the arm";
  const Duration age = now - measured->stamp;
  if (age > options_.measured_max_age) {
    return ReasonText::format("no joint state of the arm for {:.2f} s", to_seconds(age));
  }
  return {};
}

bool ArmFollowing::falls_silent(Time now, const std::optional<MeasuredJoints>& measured) {
  const ReasonText wrong = silence(now, measured);
  if (wrong.empty()) {
    measured_ = measured;
    rest_.see(measured->q, measured->stamp);
    return false;
  }
  if (!std::exchange(measured_, std::nullopt) && !trouble_.empty()) return false;
  trouble_ = wrong;
  return true;
}

void ArmFollowing::go_along(Time now) {
  trouble_.clear();
  reference_.start(measured_->q, now);
}

std::string_view ArmFollowing::stay_with(Time now) {
  const bool stopped = now >= reference_.end();
  // The power of one that rests may come back before the reference has come to its stop.
  if (!stopped && !(follows_ == false && rests())) return {};
  const JointVector stands = reference_.at(now).q;
  const auto is_within = [&](const JointBound& bound) {
    return is_near(model_, measured_->q, stands, bound);
  };
  if (follows_ == false) {
    if (rests() || !is_within(options_.max_deviation)) reference_.start(measured_->q, now);
    return {};
  }
  // An arm that follows, and sags a little, would sink if the reference came to it.
  // One that moves while the reference stands is moved by somebody.
  if (is_within(options_.goal_tolerance) || !rests()) {
    return_.allow_again();
    return {};
  }
  if (follows_ == true) return kFollows;
  return_to_arm(now);
  return return_.arm_goes_along() ? kGoesAlong : std::string_view{};
}

void ArmFollowing::return_to_arm(Time now) {
  if (follows_ == true || !rests() || now < reference_.end()) return;
  const auto part = return_.next_part(reference_.at(now).q, measured_->q, now);
  if (part) reference_.splice(*part);
}

bool ArmFollowing::strays(Time now, bool halted) {
  const JointVector wanted = reference_.at(measured_->stamp).q;
  ReasonText stray = tolerance_violation(
      model_, measured_->q, {wanted, "the reference", "max_deviation"}, options_.max_deviation);
  const bool joints_are_near = stray.empty();
  if (joints_are_near) {
    stray = tip_violation(model_, measured_->q, wanted, options_.max_tip_deviation);
  }
  const bool was_astray = std::exchange(astray_, !stray.empty());
  if (!astray_) {
    if (!halted && rests()) return_.allow_again();
    trouble_.clear();
    return false;
  }
  if (!was_astray) {
    trouble_ = stray;
    return true;
  }
  if (halted || return_.arm_goes_along() || joints_are_near) return false;
  return_to_arm(now);
  const bool stays = follows_ == true && rests() && now >= reference_.end();
  if (stays || return_.arm_goes_along()) {
    trouble_ = ReasonText::format("{}; {}", stray.view(), stays ? kFollows : kGoesAlong);
  }
  return false;
}

void ArmFollowing::begin_again(Time now) {
  trouble_.clear();
  astray_ = false;
  const bool stays = return_.arm_goes_along() || follows_ == true;
  return_.forget();
  if (!stays) reference_.start(measured_->q, now);
}

bool ArmFollowing::at_rest(Time now) const {
  if (!reference_.started()) {
    const bool silent = !measured_ && now - begin_after_ > options_.measured_max_age;
    return silent || rests();
  }
  return armature::at_rest(reference_.at(now)) && now >= reference_.end() &&
         (!measured_ || rests());
}

}  // namespace armature
