// SPDX-License-Identifier: Apache-2.0
#include "alignment_monitor.hpp"

#include <cmath>

namespace armature {
namespace {

constexpr double kStillPosition = 1e-6;  // [m] a truth that differs by less has not moved
constexpr double kStillAngle = 1e-6;     // [rad]

double angle_between(const Eigen::Vector3d& a, const Eigen::Vector3d& b) {
  return std::atan2(a.cross(b).norm(), a.dot(b));
}

}  // namespace

void AlignmentMonitor::restart_average(Time now) {
  sum_ = Face{.mouth = Eigen::Vector3d::Zero(), .normal = Eigen::Vector3d::Zero()};
  count_ = 0;
  rest_since_ = now;
}

void AlignmentMonitor::see_truth(const Face& truth, Time now) {
  const bool changed = truth_ && ((truth.mouth - truth_->mouth).norm() > kStillPosition ||
                                  angle_between(truth.normal, truth_->normal) > kStillAngle);
  truth_ = truth;
  if (!changed) return;
  moved_at_ = now;
  restart_average(now);
}

void AlignmentMonitor::see_estimate(const Face& estimate, Time stamp, Time now) {
  if (!start_) start_ = now;
  if (!found_s_) found_s_ = since_start(now);
  if (!at_rest_ || stamp < rest_since_) return;
  sum_.mouth += estimate.mouth;
  sum_.normal += estimate.normal;
  ++count_;
}

void AlignmentMonitor::see_lamp(const Eigen::Vector3d& center, const Eigen::Vector3d& light,
                                bool at_rest, Time now) {
  if (!start_) start_ = now;
  if (!at_rest || !at_rest_) restart_average(now);
  at_rest_ = at_rest;
  if (!truth_) return;
  const double distance = (center - truth_->mouth).norm();
  lamp_errors_.push_back({.time_s = since_start(now),
                          .distance_m = distance,
                          .direction_error_rad = angle_between(light, -truth_->normal)});
  if (asked_distance_m_) {
    lamp_errors_.back().distance_error_m = std::abs(distance - *asked_distance_m_);
  }
}

std::optional<EstimateError> AlignmentMonitor::estimate_error() const {
  if (!truth_ || count_ < goals_.least_frames) return std::nullopt;
  return EstimateError{.mouth_m = (sum_.mouth / count_ - truth_->mouth).norm(),
                       .normal_rad = angle_between(sum_.normal, truth_->normal)};
}

bool AlignmentMonitor::estimates_good() const {
  const auto error = estimate_error();
  return error && error->mouth_m <= goals_.mouth_error_m &&
         error->normal_rad <= goals_.normal_error_rad;
}

void AlignmentMonitor::step(Time now) {
  if (!start_) start_ = now;
  if (!found_s_ && since_start(now) > goals_.search_timeout_s) not_found_ = true;
  if (lamp_errors_.empty()) return;
  const LampError& error = lamp_errors_.back();
  const bool good = error.distance_error_m && *error.distance_error_m <= goals_.distance_error_m &&
                    error.direction_error_rad <= goals_.direction_error_rad;
  if (!good) {
    good_since_.reset();
    return;
  }
  if (!good_since_) good_since_ = now;
  const bool aligned = holding_ && estimates_good() &&
                       to_seconds(now - *good_since_) >= goals_.aligned_for_s &&
                       (!moved_at_ || to_seconds(now - *moved_at_) >= goals_.aligned_for_s);
  if (!aligned) return;
  if (!first_aligned_s_) first_aligned_s_ = since_start(now);
  if (moved_at_ && !realigned_s_) realigned_s_ = to_seconds(now - *moved_at_);
}

bool AlignmentMonitor::finished() const {
  if (not_found_) return true;
  return goals_.expect_move ? realigned_s_.has_value() : first_aligned_s_.has_value();
}

}  // namespace armature
