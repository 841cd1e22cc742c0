// SPDX-License-Identifier: Apache-2.0
#include "lamp_alignment.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

namespace armature::task::lamp_alignment {
namespace {

/// The wait between two goals that are refused has long been the longest by then.
constexpr int kMostRefusals = 20;

/// Of a face that is farther from where the lamp was sent its path is planned.
constexpr FaceBand kAlong{.position_m = 0.1, .angle_rad = 0.4};

MotionGoal face_goal(const FaceEstimate& face, double distance_m) {
  MotionGoal goal;
  goal.pose = {.position = face.mouth + distance_m * face.normal,
               .orientation = Direction{-face.normal}};
  goal.focus = face.mouth;
  return goal;
}

/// Of a lamp that goes along with the face.
MotionGoal moving_goal(const FaceEstimate& face, double distance_m) {
  MotionGoal goal = face_goal(face, distance_m);
  goal.mode = MotionMode::tracking;
  goal.velocity = face.velocity + distance_m * face.normal_rate;
  goal.angular_velocity = face.angular_velocity();
  return goal;
}

std::size_t window_of(const Parameters& parameters) {
  return static_cast<std::size_t>(parameters.settle_frames) * 3;
}

}  // namespace

const char* to_string(LampAlignment::Phase phase) {
  switch (phase) {
    case LampAlignment::Phase::checking_light: return "checking light";
    case LampAlignment::Phase::searching: return "searching";
    case LampAlignment::Phase::aligning: return "aligning";
    case LampAlignment::Phase::holding: return "holding";
    case LampAlignment::Phase::following: return "following";
    case LampAlignment::Phase::no_view:
    case LampAlignment::Phase::unreachable: return "unreachable";
    case LampAlignment::Phase::aborting: return "aborting";
    case LampAlignment::Phase::aborted: return "aborted";
  }
  return "";
}

LampAlignment::LampAlignment(const Parameters& parameters, double joint_6_to_lamp)
    : parameters_{parameters},
      few_{static_cast<std::size_t>(parameters.moved_frames)},
      procedure_{{{.name = "light"},
                  {.name = "search", .asks = true},
                  {.name = "alignment", .asks = true}},
                 parameters.auto_confirm},
      settled_{parameters.settled_position, parameters.settled_angle},
      replan_{parameters.replan_position, parameters.replan_angle},
      moved_{parameters.moved_position, parameters.moved_angle},
      poses_{search_poses(parameters, joint_6_to_lamp)},
      light_{parameters},
      face_{parameters},
      at_rest_{window_of(parameters)},
      recent_{few_},
      new_level_{light_.level()} {}

void LampAlignment::see(const Picture& picture, Time now) {
  face_.see(picture, now);
  const double intensity = picture.face ? picture.face_intensity : picture.image_intensity;
  const bool answers = light_.answers(picture.stamp);
  if (picture.face || phase_ == Phase::checking_light) {
    const auto level = light_.update(picture.stamp, intensity, now);
    if (level) new_level_ = level;
    if (phase_ == Phase::checking_light && answers && !level) start_search(now);
  }
  if (answers) light_trouble_ = light_.end(intensity);
  if (phase_ == Phase::searching && looking_ && picture.stamp >= looking_since_) {
    ++pictures_;
    face_in_picture_ = face_in_picture_ || picture.face;
  }
}

void LampAlignment::see(const Verdict& verdict) {
  face_.see(verdict);
  if (!verdict.can_be_used && verdict.stamp >= looking_since_)
    pictures_ = std::max(pictures_ - 1, 0);
}

void LampAlignment::see(const FaceEstimate& estimate) {
  const bool follows_others = face_.is_fresh(estimate.stamp);
  if (!face_.see(estimate)) return;
  if (!follows_others) {
    recent_.clear();
    at_rest_.clear();
  }
  recent_.add(estimate);
  if (goals_.state() == GoalState::done && estimate.stamp >= goals_.done_at()) {
    at_rest_.add(estimate);
  }
}

std::string LampAlignment::trouble() const {
  if (!blindness_.empty()) return blindness_;
  return trouble_.empty() ? light_trouble_ : trouble_;
}

void LampAlignment::step(Time now) {
  if (!capture_) captures_since_.reset();
  if (capture_ && !captures_since_) captures_since_ = now;
  blindness_ = captures_since_ ? face_.blindness(*captures_since_, now) : "";
  if (procedure_.paused() || leaves_face_found_elsewhere(now)) return;
  switch (phase_) {
    case Phase::checking_light: aligns_with_seen_face(Step::light, now); break;
    case Phase::searching: search(now); break;
    case Phase::no_view: wait_for_a_view(now); break;
    case Phase::aligning:
    case Phase::following:
      if (goes_along_ && face_.is_fresh(now)) {
        go_along(now);
      } else {
        come_to_rest(now);
      }
      break;
    case Phase::holding: hold(now); break;
    case Phase::unreachable: wait_for_another_face_position(now); break;
    case Phase::aborting: end_abort(); break;
    case Phase::aborted: break;
  }
}

std::optional<MotionGoal> LampAlignment::outgoing_goal(Time now) {
  if (is_at_a_face() && goals_.state() == GoalState::waiting) {
    // Behind an outage a few estimates tell whether the patient is still there.
    const bool is_old = to_seconds(now - goal_estimate_->stamp) > parameters_.lost;
    if (!is_fresh(now) || (is_old && recent_.count() < few_)) return std::nullopt;
  }
  return goals_.outgoing(now);
}

bool LampAlignment::may_align(Time now) {
  if (step() != Step::alignment) {
    procedure_.enter(static_cast<std::size_t>(Step::alignment));
    asked_about_ = latest();
  } else if (!procedure_.auto_confirm() && is_elsewhere(*asked_about_)) {
    ask_whose_face(*asked_about_, now);
  }
  return procedure_.may_act();
}

bool LampAlignment::is_elsewhere(const FaceEstimate& before) const {
  return (latest().mouth - before.mouth).norm() > kAlong.position_m;
}

void LampAlignment::ask_whose_face(const FaceEstimate& before, Time now) {
  trouble_ = fmt::format("the face is {:.0f} mm from where it was: is it the patient's?",
                         1e3 * (latest().mouth - before.mouth).norm());
  procedure_.enter(static_cast<std::size_t>(Step::alignment));
  asked_about_ = latest();
  asked_whose_at_ = now;
}

bool LampAlignment::leaves_face_found_elsewhere(Time now) {
  if (!is_at_a_face() || !face_.is_found_anew() || !is_fresh(now)) return false;
  face_.know_it();
  if (!is_elsewhere(*goal_estimate_)) return false;
  if (procedure_.auto_confirm()) {
    align_with(latest(), Phase::aligning, now);
    return true;
  }
  goals_.leave();
  ask_whose_face(*goal_estimate_, now);
  phase_ = Phase::searching;
  looking_ = capture_ = true;
  looking_since_ = latest().stamp;
  return true;
}

bool LampAlignment::aligns_with_seen_face(Step before, Time now) {
  if (!face_.seen_since(looking_since_)) return false;
  if (is_fresh(now)) {
    if (may_align(now)) align_with(latest(), Phase::aligning, now);
    return true;
  }
  if (step() == Step::alignment) {
    procedure_.enter(static_cast<std::size_t>(before));
    trouble_.clear();
    sets_out_ = phase_ == Phase::no_view;
  }
  looking_since_ = now;
  pictures_ = 0;
  return false;
}

void LampAlignment::align_with(const FaceEstimate& estimate, Phase phase, Time now) {
  // Who is far is gone to by a planned way, before the lamp goes along with him.
  const bool is_far = goal_estimate_ && kAlong.left_by(estimate, *goal_estimate_);
  phase_ = is_far && phase == Phase::following ? Phase::aligning : phase;
  goes_along_ = false;
  capture_ = true;
  trouble_.clear();
  face_.know_it();
  goal_estimate_ = estimate;
  goal_set_at_ = now;
  recent_.clear();
  at_rest_.clear();
  goals_.set(face_goal(estimate, parameters_.distance));
}

std::string LampAlignment::failure(const char* goes_on_for) const {
  if (!goals_.stopped() || !goals_.may_move()) return goals_.reason();
  return fmt::format("it was stopped: {}, or 'back', makes it go on", goes_on_for);
}

bool LampAlignment::has_moved() const { return recent_.have_left(few_, moved_, *goal_estimate_); }

void LampAlignment::follow_if_moved(Time now) {
  if (to_seconds(now - goal_set_at_) < parameters_.replan_interval || !has_moved()) return;
  align_with(recent(), phase_, now);  // the first approach stays one
}

bool LampAlignment::may_go_along() const {
  return recent_.count() > 0 && face_.begins_to_move() &&
         settled_.left_by(latest(), *goal_estimate_) && !kAlong.left_by(latest(), *goal_estimate_);
}

/// A new target in every step, so that the arm never waits for the next picture.
void LampAlignment::go_along(Time now) {
  phase_ = Phase::following;
  if (goals_.stopped()) return come_to_rest(now);
  if (goes_along_ && !goals_.may_move()) return;  // the newest goal is answered soon
  if (goals_.state() == GoalState::failed) return align_with(latest(), phase_, now);
  const Time last = latest().stamp + seconds(parameters_.max_prediction);
  const bool is_far = kAlong.left_by(latest().at(now), *goal_estimate_);
  if (face_.stays_still() || now > last || is_far) return end_going_along(now);
  goes_along_ = true;
  goal_estimate_ = latest().at(now);
  goal_set_at_ = now;
  goals_.set(moving_goal(*goal_estimate_, parameters_.distance));
}

/// To where the patient has stopped; there the estimates are averaged.
void LampAlignment::end_going_along(Time now) {
  const Time last = latest().stamp + seconds(parameters_.max_prediction);
  FaceEstimate rests = face_.is_still() ? latest() : latest().at(std::min(now, last));
  rests.velocity = rests.normal_rate = Eigen::Vector3d::Zero();
  align_with(rests, Phase::following, now);
}

bool LampAlignment::lost() const {
  return goals_.state() == GoalState::done && face_.lost(goals_.done_at());
}

void LampAlignment::come_to_rest(Time now) {
  if (goals_.state() == GoalState::failed) {
    phase_ = Phase::unreachable;
    trouble_ = refusal_ = failure("a patient who moves");
    refused_ = 1;
    return;
  }
  if (goals_.state() != GoalState::done) {
    const bool waits = goals_.state() == GoalState::waiting;
    if (waits && face_.lost(goal_set_at_)) return search_for_lost_face(now);
    trouble_ = waits ? face_.disbelief(goal_set_at_) : "";
    if (!is_fresh(now)) return;
    // After the first approach the arm is near, and goals for where he was would trail him.
    if (phase_ == Phase::following && may_go_along()) return go_along(now);
    follow_if_moved(now);
    return;
  }
  if (lost()) {
    search_for_lost_face(now);
    return;
  }
  trouble_ = face_.disbelief(goals_.done_at());
  if (!is_fresh(now)) return;
  if (may_go_along()) return go_along(now);
  const auto frames = static_cast<std::size_t>(parameters_.settle_frames);
  if (at_rest_.count() >= few_ && has_moved()) {
    align_with(recent(), phase_, now);
    return;
  }
  if (at_rest_.count() < frames) return;
  const FaceEstimate mean = at_rest_.mean(frames, moved_);
  if (settled_.left_by(mean, *goal_estimate_)) {
    align_with(mean, phase_, now);
  } else {
    phase_ = Phase::holding;
  }
}

void LampAlignment::hold(Time now) {
  if (lost()) {
    search_for_lost_face(now);
    return;
  }
  trouble_ = face_.disbelief(goals_.done_at());
  if (!is_fresh(now)) return;
  if (may_go_along()) return go_along(now);
  if (has_moved()) {
    align_with(recent(), Phase::following, now);
    return;
  }
  const FaceEstimate mean = at_rest_.mean(window_of(parameters_), moved_);
  if (at_rest_.count() >= window_of(parameters_) && replan_.left_by(mean, *goal_estimate_)) {
    align_with(mean, Phase::aligning, now);
  }
}

void LampAlignment::wait_for_another_face_position(Time now) {
  if (goals_.state() == GoalState::moving || goals_.state() == GoalState::done) {
    phase_ = Phase::aligning;
    trouble_.clear();
    return;
  }
  if (face_.lost(goal_set_at_) && !goals_.stopped()) {
    search_for_lost_face(now);
    return;
  }
  if (goals_.state() == GoalState::failed) refusal_ = failure("a patient who moves");
  const std::string doubt = face_.disbelief(goal_set_at_);
  trouble_ = doubt.empty() ? refusal_ : doubt;
  const double wait_s = std::min(std::ldexp(parameters_.replan_interval, refused_ - 1),
                                 parameters_.max_retry_interval);
  if (to_seconds(now - goal_set_at_) < wait_s) return;
  if (!is_fresh(now) || recent_.count() < few_) return;
  if (goals_.stopped() ? has_moved() : settled_.left_by(latest(), *goal_estimate_)) {
    align_with(recent(), Phase::unreachable, now);
    refused_ = std::min(refused_ + 1, kMostRefusals);
    trouble_ = refusal_;  // until a goal is accepted
  }
}

}  // namespace armature::task::lamp_alignment
