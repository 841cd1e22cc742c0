// SPDX-License-Identifier: Apache-2.0
// The search for a face: from view to view, until one is seen and believed.
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <utility>

#include "lamp_alignment.hpp"

namespace armature::task::lamp_alignment {
namespace {

/// A face in the picture but no estimate yet: so many more pictures to wait for one.
constexpr int kPicturesForEstimate = 10;
/// When every search pose failed, the next one is tried after so long.
constexpr double kNextTry_s = 1;

}  // namespace

void LampAlignment::start_search(Time now) {
  phase_ = Phase::searching;
  trouble_.clear();
  views_looked_at_ = failed_views_ = 0;
  faceless_.clear();
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
  goals_.leave();
  start_search(now);
  if (!face_.no_estimate().empty()) trouble_ = "the face was lost: " + face_.no_estimate();
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
  if (looking_ && aligns_with_seen_face(Step::search, now)) return;
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
      face_.forget_refusal();
    }
    return;
  }
  if (face_.is_unusable()) return;
  const int enough = parameters_.frames_per_view + (face_in_picture_ ? kPicturesForEstimate : 0);
  if (pictures_ < enough) return;
  trouble_ = reason_to_leave();
  next_view();
}

/// Why the view has given no face; what the views without any have told, once they all have been
/// looked at.
std::string LampAlignment::reason_to_leave() {
  const std::string& reason = face_.no_estimate();
  if (!face_in_picture_ && !reason.empty() &&
      std::ranges::find(faceless_, reason) == faceless_.end())
    faceless_.push_back(reason);
  const bool ends_round = views_looked_at_ == poses_.size();
  const auto told = ends_round ? std::exchange(faceless_, {}) : std::vector<std::string>{};
  if (!face_.refusal().empty()) {
    return fmt::format("in view {} a face was seen but not believed: {}", views_looked_at_,
                       face_.refusal());
  }
  return told.empty() ? "" : fmt::format("no view gave a face: {}", fmt::join(told, "; "));
}

void LampAlignment::leave_failed_view(Time now) {
  if (++failed_views_ < poses_.size() && !goals_.stopped()) {
    trouble_ = "search pose: " + goals_.reason();
    next_view();
    return;
  }
  phase_ = Phase::no_view;
  if (!goals_.stopped()) trouble_ = "every search pose failed, the last one: " + goals_.reason();
  capture_ = true;
  looking_since_ = goal_set_at_ = now;
}

void LampAlignment::wait_for_a_view(Time now) {
  if (goals_.stopped()) trouble_ = failure("a face before it");
  if (aligns_with_seen_face(Step::search, now) || !procedure_.may_act()) return;
  if (goals_.state() == GoalState::moving || goals_.state() == GoalState::done) {
    phase_ = Phase::searching;
    trouble_.clear();
    failed_views_ = 0;
    capture_ = false;
    return;
  }
  const bool may_try_next = goals_.state() == GoalState::failed && !goals_.stopped() &&
                            to_seconds(now - goal_set_at_) >= kNextTry_s;
  if (std::exchange(sets_out_, false) || may_try_next) {
    next_view();
    capture_ = true;
    goal_set_at_ = now;
  }
}

}  // namespace armature::task::lamp_alignment
