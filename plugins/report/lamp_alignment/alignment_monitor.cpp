// SPDX-License-Identifier: Apache-2.0
#include "alignment_monitor.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>

#include "armature/values/angles.hpp"

namespace armature::report::lamp_alignment {
namespace {

constexpr double kStillPosition = 1e-6;  // [m] a truth that differs by less has not moved
constexpr double kStillAngle = 1e-6;     // [rad]
constexpr double kMillimetre = 1e-3;

double angle_between(const Eigen::Vector3d& a, const Eigen::Vector3d& b) {
  return std::atan2(a.cross(b).norm(), a.dot(b));
}

}  // namespace

void AlignmentMonitor::restart_average(Time now) {
  sum_ = Face{.mouth = Eigen::Vector3d::Zero(), .normal = Eigen::Vector3d::Zero()};
  count_ = 0;
  rest_since_ = now;
}

void AlignmentMonitor::see_truth(const TargetEstimate& truth, Time now) {
  const bool changed = truth_ && ((truth.position - truth_->position).norm() > kStillPosition ||
                                  angle_between(truth.normal, truth_->normal) > kStillAngle);
  truth_ = truth;
  if (!changed) return;
  moved_at_ = now;
  restart_average(now);
}

void AlignmentMonitor::see_estimate(const TargetEstimate& estimate, Time now) {
  if (!start_) start_ = now;
  if (!found_s_) found_s_ = since_start(now);
  newest_ = estimate;
  if (!at_rest_ || estimate.stamp < rest_since_) return;
  sum_.mouth += estimate.position;
  sum_.normal += estimate.normal;
  ++count_;
}

void AlignmentMonitor::see_lamp(const Eigen::Vector3d& center, const Eigen::Vector3d& light,
                                bool at_rest, Time stamp, Time now) {
  if (!start_) start_ = now;
  if (!at_rest || !at_rest_) restart_average(now);
  at_rest_ = at_rest;
  if (!truth_) return;
  const Face truth = face_at(*truth_, stamp);
  const double distance = (center - truth.mouth).norm();
  LampError& error = lamp_errors_.emplace_back(
      LampError{.time_s = since_start(now),
                .distance_m = distance,
                .direction_error_rad = angle_between(light, -truth.normal)});
  if (asked_distance_m_) error.distance_error_m = std::abs(distance - *asked_distance_m_);
  if (!newest_) return;
  const Face newest = face_at(*newest_, stamp);
  error.mouth_error_m = (newest.mouth - truth.mouth).norm();
  error.normal_error_rad = angle_between(newest.normal, truth.normal);
}

std::optional<EstimateError> AlignmentMonitor::estimate_error() const {
  if (!truth_ || count_ < parameters_.min_frames) return std::nullopt;
  return EstimateError{.mouth = sum_.mouth / count_ - truth_->position,
                       .normal_rad = angle_between(sum_.normal, truth_->normal)};
}

std::array<AlignmentCheck, 2> AlignmentMonitor::estimate_checks() const {
  std::array<AlignmentCheck, 2> checks{{
      {.name = "mouth_position_error_mm",
       .limit = parameters_.mouth_position_error,
       .unit = kMillimetre},
      {.name = "face_normal_error_deg",
       .limit = parameters_.face_normal_error,
       .unit = kRadPerDegree},
  }};
  if (const auto error = estimate_error()) {
    checks[0].value = error->mouth.norm();
    checks[1].value = error->normal_rad;
  }
  return checks;
}

std::array<AlignmentCheck, 2> AlignmentMonitor::lamp_checks() const {
  std::array<AlignmentCheck, 2> checks{{
      {.name = "distance_error_mm", .limit = parameters_.distance_error, .unit = kMillimetre},
      {.name = "direction_error_deg", .limit = parameters_.direction_error, .unit = kRadPerDegree},
  }};
  if (!lamp_errors_.empty()) {
    checks[0].value = lamp_errors_.back().distance_error_m;
    checks[1].value = lamp_errors_.back().direction_error_rad;
  }
  return checks;
}

std::vector<std::string> AlignmentMonitor::missing() const {
  if (!found_s_) return {"no face was found"};
  if (parameters_.expect_move && first_aligned_s_ && !moved_at_) {
    return {"the patient has not moved"};
  }
  std::vector<std::string> missing;
  const auto tell = [&](const AlignmentCheck& check) {
    if (check.met()) return;
    missing.push_back(check.value ? fmt::format("{} is {:.3f}, the report asks for at most {:g}",
                                                check.name, *check.value / check.unit,
                                                check.limit / check.unit)
                                  : fmt::format("{} was not measured", check.name));
  };
  std::ranges::for_each(lamp_checks(), tell);
  std::ranges::for_each(estimate_checks(), tell);
  if (missing.empty()) {
    missing.push_back(
        fmt::format("it was not aligned and holding for {:g} s", parameters_.aligned_for));
  }
  return missing;
}

void AlignmentMonitor::step(Time now) {
  if (!start_) start_ = now;
  if (!found_s_ && since_start(now) > parameters_.search_timeout) not_found_ = true;
  if (lamp_errors_.empty()) return;
  if (!std::ranges::all_of(lamp_checks(), &AlignmentCheck::met)) {
    good_since_.reset();
    return;
  }
  if (!good_since_) good_since_ = now;
  const bool aligned = holding_ && std::ranges::all_of(estimate_checks(), &AlignmentCheck::met) &&
                       to_seconds(now - *good_since_) >= parameters_.aligned_for &&
                       (!moved_at_ || to_seconds(now - *moved_at_) >= parameters_.aligned_for);
  if (!aligned) return;
  if (!first_aligned_s_) first_aligned_s_ = since_start(now);
  if (moved_at_ && !realigned_s_) realigned_s_ = to_seconds(now - *moved_at_);
}

bool AlignmentMonitor::finished() const {
  if (not_found_) return true;
  return parameters_.expect_move ? realigned_s_.has_value() : first_aligned_s_.has_value();
}

}  // namespace armature::report::lamp_alignment
