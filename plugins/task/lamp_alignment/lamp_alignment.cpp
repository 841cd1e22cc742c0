// SPDX-License-Identifier: Apache-2.0
#include "lamp_alignment.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "armature/task/obey.hpp"

namespace armature::task::lamp_alignment {
namespace {

/// A face in the picture but no estimate yet: so many more pictures to wait for one.
constexpr int kPicturesForEstimate = 10;
/// The wait between two goals that are refused has long been the longest by then.
constexpr int kMostRefusals = 20;
/// When every search pose failed, the next one is tried after so long.
constexpr double kNextTry_s = 1;

/// So many estimates in a row say that the patient moves.
constexpr int kBeginsToMove = 2;
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

Eigen::Vector3d shortened(const Eigen::Vector3d& vector, double most) {
  const double length = vector.norm();
  return length > most ? Eigen::Vector3d{vector * (most / length)} : vector;
}

std::size_t window_of(const Parameters& parameters) {
  return static_cast<std::size_t>(parameters.settle_frames) * 3;
}

}  // namespace

const char* to_string(LampAlignment::Phase phase) {
  switch (phase) {
    case LampAlignment::Phase::checking_light:
      return "checking light";
    case LampAlignment::Phase::searching:
      return "searching";
    case LampAlignment::Phase::aligning:
      return "aligning";
    case LampAlignment::Phase::holding:
      return "holding";
    case LampAlignment::Phase::following:
      return "following";
    case LampAlignment::Phase::no_view:
    case LampAlignment::Phase::unreachable:
      return "unreachable";
    case LampAlignment::Phase::aborting:
      return "aborting";
    case LampAlignment::Phase::aborted:
      return "aborted";
  }
  return "";
}

LampAlignment::LampAlignment(const Parameters& parameters, double joint_6_to_lamp)
    : parameters_{parameters},
      procedure_{{{.name = "light"},
                  {.name = "search", .asks = true},
                  {.name = "alignment", .asks = true}},
                 parameters.auto_confirm},
      settled_{parameters.settled_position, parameters.settled_angle},
      replan_{parameters.replan_position, parameters.replan_angle},
      moved_{parameters.moved_position, parameters.moved_angle},
      poses_{search_poses(parameters, joint_6_to_lamp)},
      light_{parameters},
      at_rest_{window_of(parameters)} {}

void LampAlignment::see(const Picture& picture, Time now) {
  shows_face_ = picture.face;
  if (picture.face) face_in_picture_at_ = picture.stamp;
  if (picture.face || phase_ == Phase::checking_light) {
    const double intensity = picture.face ? picture.face_intensity : picture.image_intensity;
    const bool answers = light_.answers(picture.stamp);
    const auto level = light_.update(picture.stamp, intensity, now);
    if (level) new_level_ = level;
    if (phase_ == Phase::checking_light && answers && !level) start_search(now);
  }
  if (phase_ == Phase::searching && looking_ && picture.stamp >= looking_since_) {
    ++pictures_;
    face_in_picture_ = face_in_picture_ || picture.face;
  }
}

void LampAlignment::see_no_estimate(const std::string& why) {
  no_estimate_ = why;
  if (shows_face_) disbelief_ = why;
}

// A prediction over pictures without a measurement moves nothing: at(now) predicts better.
void LampAlignment::see(const FaceEstimate& estimate) {
  if (std::exchange(measurements_, estimate.measurements) == estimate.measurements) return;
  if (estimate.measurements < parameters_.min_measurements) {
    see_no_estimate(fmt::format("it was measured {} times, {} times are wanted",
                                estimate.measurements, parameters_.min_measurements));
    return;
  }
  const bool moves = estimate.velocity.norm() > parameters_.moving_speed ||
                     estimate.normal_rate.norm() > parameters_.moving_turn;
  moving_ = moves ? moving_ + 1 : 0;
  still_ = moves ? 0 : still_ + 1;
  latest_ = estimate;
  latest_->velocity = shortened(estimate.velocity, parameters_.max_speed);
  latest_->normal_rate = shortened(estimate.normal_rate, parameters_.max_turn);
  no_estimate_.clear();
  disbelief_.clear();
  ++fresh_;
  if (goals_.state() == GoalState::done && estimate.stamp >= goals_.done_at()) {
    at_rest_.add(estimate);
  }
}

void LampAlignment::step(Time now) {
  if (procedure_.paused()) return;
  switch (phase_) {
    case Phase::checking_light:
      if (latest_ && may_align()) align_with(*latest_, Phase::aligning, now);
      break;
    case Phase::searching:
      search(now);
      break;
    case Phase::no_view:
      wait_for_a_view(now);
      break;
    case Phase::aligning:
    case Phase::following:
      if (goes_along_) {
        go_along(now);
      } else {
        come_to_rest(now);
      }
      break;
    case Phase::holding:
      hold(now);
      break;
    case Phase::unreachable:
      wait_for_another_face_position(now);
      break;
    case Phase::aborting:
      end_abort();
      break;
    case Phase::aborted:
      break;
  }
}

bool LampAlignment::may_align() {
  if (step() != Step::alignment) procedure_.enter(static_cast<std::size_t>(Step::alignment));
  return procedure_.may_act();
}

Expected<void> LampAlignment::hear(const OperatorCommand& command, Time now) {
  return obey(
      command, procedure_, goals_, [&] { return go_back(now); }, [&] { return abort(); });
}

Expected<void> LampAlignment::go_back(Time now) {
  if (phase_ == Phase::aborting) return refuse("it is being aborted");
  if (step() != Step::alignment) return refuse("the search is the first step that moves the lamp");
  procedure_.turn_back();
  goals_.set({.mode = MotionMode::hold, .pose = {}});
  start_search(now);
  return {};
}

/// To the view from which it saw the face, if it has left one; else it stays where it is.
Expected<void> LampAlignment::abort() {
  if (phase_ == Phase::aborting) return refuse("it is being aborted already");
  procedure_.turn_back();
  const bool came_from_a_view = step() == Step::alignment && views_looked_at_ > 0;
  MotionGoal goal{.mode = MotionMode::hold, .pose = {}};
  if (came_from_a_view) goal = {.pose = poses_[pose_]};
  if (goals_.state() != GoalState::none) goals_.set(goal);
  phase_ = Phase::aborting;
  trouble_.clear();
  capture_ = false;
  return {};
}

void LampAlignment::end_abort() {
  if (goals_.state() == GoalState::failed) trouble_ = "the way back failed: " + goals_.reason();
  const bool under_way =
      goals_.state() == GoalState::waiting || goals_.state() == GoalState::moving;
  if (under_way) return;
  phase_ = Phase::aborted;
  procedure_.end(Procedure::StepState::broken_off);
}

void LampAlignment::start_search(Time now) {
  phase_ = Phase::searching;
  trouble_.clear();
  views_looked_at_ = failed_views_ = 0;
  pose_ = 0;
  if (goal_estimate_) pose_ = nearest_pose(poses_, -goal_estimate_->normal);
  pose_ = (pose_ + poses_.size() - 1) % poses_.size();
  looking_since_ = now;
  looking_ = false;
  sets_out_ = true;
  procedure_.enter(static_cast<std::size_t>(Step::search));
  set_out();
}

void LampAlignment::set_out() {
  if (procedure_.may_act() && std::exchange(sets_out_, false)) next_view();
}

void LampAlignment::search_for_lost_face(Time now) {
  start_search(now);
  if (!no_estimate_.empty()) trouble_ = "the face was lost: " + no_estimate_;
}

void LampAlignment::next_view() {
  pose_ = (pose_ + 1) % poses_.size();
  views_looked_at_ = views_looked_at_ % poses_.size() + 1;
  looking_ = false;
  capture_ = false;
  MotionGoal goal;
  goal.pose = poses_[pose_];
  goals_.set(goal);
}

void LampAlignment::search(Time now) {
  if (face_since(looking_since_) && looking_) {
    if (may_align()) return align_with(*latest_, Phase::aligning, now);
    if (to_seconds(now - latest_->stamp) <= parameters_.lost) return;
    procedure_.enter(static_cast<std::size_t>(Step::search));  // it asks no more for what is lost
    looking_since_ = now;
    pictures_ = 0;
  }
  if (!procedure_.may_act()) return;
  set_out();
  if (!looking_) {
    if (goals_.state() == GoalState::failed) {
      leave_failed_view(now);
    } else if (goals_.state() == GoalState::done) {
      failed_views_ = 0;
      looking_ = capture_ = true;
      looking_since_ = now;
      pictures_ = 0;
      face_in_picture_ = false;
      disbelief_.clear();
    }
    return;
  }
  const int enough = parameters_.frames_per_view + (face_in_picture_ ? kPicturesForEstimate : 0);
  if (pictures_ < enough) return;
  trouble_ = disbelief_.empty() ? ""
                                : fmt::format("in view {} a face was seen but not believed: {}",
                                              views_looked_at_, disbelief_);
  next_view();
}

void LampAlignment::leave_failed_view(Time now) {
  if (++failed_views_ < poses_.size() && !goals_.stopped()) {
    trouble_ = "search pose: " + goals_.reason();
    next_view();
    return;
  }
  phase_ = Phase::no_view;
  trouble_ = goals_.stopped() ? goals_.reason()
                              : "every search pose failed, the last one: " + goals_.reason();
  capture_ = true;
  looking_since_ = goal_set_at_ = now;
}

void LampAlignment::wait_for_a_view(Time now) {
  if (face_since(looking_since_)) {
    if (may_align()) align_with(*latest_, Phase::aligning, now);
  } else if (goals_.state() == GoalState::moving || goals_.state() == GoalState::done) {
    phase_ = Phase::searching;
    trouble_.clear();
    failed_views_ = 0;
    capture_ = false;
  } else if (goals_.state() == GoalState::failed && !goals_.stopped() &&
             to_seconds(now - goal_set_at_) >= kNextTry_s) {
    next_view();
    capture_ = true;
    goal_set_at_ = now;
  }
}

void LampAlignment::align_with(const FaceEstimate& estimate, Phase phase, Time now) {
  phase_ = phase;
  goes_along_ = false;
  capture_ = true;
  trouble_.clear();
  goal_estimate_ = estimate;
  goal_set_at_ = now;
  fresh_ = 0;
  at_rest_.clear();
  goals_.set(face_goal(estimate, parameters_.distance));
}

bool LampAlignment::follow_if_moved(Time now) {
  if (to_seconds(now - goal_set_at_) < parameters_.replan_interval) return false;
  if (!latest_ || fresh_ == 0 || !moved_.left_by(*latest_, *goal_estimate_)) return false;
  align_with(*latest_, phase_, now);  // the first approach stays one
  return true;
}

bool LampAlignment::may_go_along() const {
  return fresh_ > 0 && moving_ >= kBeginsToMove && settled_.left_by(*latest_, *goal_estimate_) &&
         !kAlong.left_by(*latest_, *goal_estimate_);
}

/// A new target in every step, so that the arm never waits for the next picture.
void LampAlignment::go_along(Time now) {
  phase_ = Phase::following;
  if (goals_.state() == GoalState::failed) return align_with(*latest_, phase_, now);
  const Time last = latest_->stamp + seconds(parameters_.max_prediction);
  if (still_ >= parameters_.settle_frames || now > last) return end_going_along(now);
  goes_along_ = true;
  goal_estimate_ = latest_->at(now);
  goal_set_at_ = now;
  goals_.set(moving_goal(*goal_estimate_, parameters_.distance));
}

/// To where the patient has stopped; there the estimates are averaged.
void LampAlignment::end_going_along(Time now) {
  const Time last = latest_->stamp + seconds(parameters_.max_prediction);
  FaceEstimate rests = still_ > 0 ? *latest_ : latest_->at(std::min(now, last));
  rests.velocity = rests.normal_rate = Eigen::Vector3d::Zero();
  align_with(rests, Phase::following, now);
}

bool LampAlignment::lost(Time now) const {
  const Time since = std::max({latest_->stamp, face_in_picture_at_, goals_.done_at()});
  return goals_.state() == GoalState::done && to_seconds(now - since) > parameters_.lost;
}

void LampAlignment::tell_disbelief(Time now) {
  const Time since = std::max(latest_->stamp, goals_.done_at());
  trouble_.clear();
  if (to_seconds(now - since) <= parameters_.lost) return;
  trouble_ = "a face is seen but not believed: " +
             (disbelief_.empty() ? "nobody tells where it is" : disbelief_);
}

void LampAlignment::come_to_rest(Time now) {
  if (goals_.state() == GoalState::failed) {
    phase_ = Phase::unreachable;
    trouble_ = goals_.reason();
    refused_ = 1;
    return;
  }
  if (goals_.state() != GoalState::done) {
    follow_if_moved(now);
    return;
  }
  if (lost(now)) {
    search_for_lost_face(now);
    return;
  }
  tell_disbelief(now);
  if (may_go_along()) return go_along(now);
  const auto frames = static_cast<std::size_t>(parameters_.settle_frames);
  const auto few = static_cast<std::size_t>(parameters_.moved_frames);
  if (at_rest_.count() == few && moved_.left_by(at_rest_.mean(few), *goal_estimate_)) {
    align_with(at_rest_.mean(few), phase_, now);
    return;
  }
  if (at_rest_.count() < frames) return;
  const FaceEstimate mean = at_rest_.mean(frames);
  if (settled_.left_by(mean, *goal_estimate_)) {
    align_with(mean, phase_, now);
  } else {
    phase_ = Phase::holding;
  }
}

void LampAlignment::hold(Time now) {
  if (lost(now)) {
    search_for_lost_face(now);
    return;
  }
  tell_disbelief(now);
  if (may_go_along()) return go_along(now);
  const auto few = static_cast<std::size_t>(parameters_.moved_frames);
  const FaceEstimate recent = at_rest_.mean(few);
  if (moved_.left_by(recent, *goal_estimate_)) {
    align_with(*latest_, Phase::following, now);
    return;
  }
  const FaceEstimate mean = at_rest_.mean(window_of(parameters_));
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
  const bool lost = latest_ && to_seconds(now - latest_->stamp) > parameters_.lost;
  if (lost && !goals_.stopped()) {
    search_for_lost_face(now);
    return;
  }
  const double wait_s = std::min(std::ldexp(parameters_.replan_interval, refused_ - 1),
                                 parameters_.max_retry_interval);
  if (to_seconds(now - goal_set_at_) < wait_s) return;
  const auto& elsewhere = goals_.stopped() ? moved_ : settled_;
  if (elsewhere.left_by(*latest_, *goal_estimate_)) {
    const std::string why = trouble_;
    align_with(*latest_, Phase::unreachable, now);
    refused_ = std::min(refused_ + 1, kMostRefusals);
    trouble_ = why;  // until a goal is accepted
  }
}

}  // namespace armature::task::lamp_alignment
