// SPDX-License-Identifier: Apache-2.0
#include "face_watch.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

namespace armature::task::lamp_alignment {
namespace {

/// So many estimates in a row say that the patient moves.
constexpr int kBeginsToMove = 2;

Eigen::Vector3d shortened(const Eigen::Vector3d& vector, double most) {
  const double length = vector.norm();
  return length > most ? Eigen::Vector3d{vector * (most / length)} : vector;
}

}  // namespace

void FaceWatch::see(const Picture& picture, Time now) {
  face_ = picture.face;
  if (picture.face && !is_no_patient_) face_at_ = picture.stamp;
  if (is_longer_than_lost(picture_at_, picture.stamp)) begins_at_ = picture.stamp;
  period_ = picture.stamp - picture_at_;
  picture_at_ = picture.stamp;
  picture_came_ = now;
}

void FaceWatch::see(const Verdict& verdict) {
  if (!verdict.refusal.empty()) see_no_estimate(verdict.refusal);
  if (verdict.can_be_used) {
    unusable_.reset();
    return;
  }
  unusable_ = {.since = unusable_ ? unusable_->since : verdict.stamp, .why = verdict.refusal};
  const bool is_blind = is_longer_than_lost(unusable_->since, verdict.stamp);
  begins_at_ =
      is_blind ? verdict.stamp : std::min(std::max(begins_at_, face_at_) + period_, verdict.stamp);
}

bool FaceWatch::see(const FaceEstimate& estimate) {
  const int before = std::exchange(measurements_, estimate.measurements);
  if (before == estimate.measurements) return false;
  if (estimate.measurements < before) {
    begins_anew_ = latest_.has_value();
    is_no_patient_ = false;
  }
  if (estimate.measurements < parameters_.min_measurements) {
    see_no_estimate(
        fmt::format("it was measured {} times, {} times are wanted, none more than "
                    "the target's max_gap_s after the one before",
                    estimate.measurements, parameters_.min_measurements));
    return false;
  }
  const Eigen::Vector3d& at = estimate.mouth;
  is_no_patient_ = !is_where_patients_are(at);
  if (is_no_patient_) {
    see_no_estimate(fmt::format("a face at ({:.1f}, {:.1f}, {:.1f}) m is not where patients are",
                                at.x(), at.y(), at.z()));
    return false;
  }
  const bool moves = estimate.velocity.norm() > parameters_.moving_speed ||
                     estimate.normal_rate.norm() > parameters_.moving_turn;
  moving_ = moves ? moving_ + 1 : 0;
  still_ = moves ? 0 : still_ + 1;
  is_found_anew_ = std::exchange(begins_anew_, false) || is_found_anew_;
  latest_ = estimate;
  latest_->velocity = shortened(estimate.velocity, parameters_.max_speed);
  latest_->normal_rate = shortened(estimate.normal_rate, parameters_.max_turn);
  no_estimate_.clear();
  refusal_.clear();
  return true;
}

bool FaceWatch::is_where_patients_are(const Eigen::Vector3d& mouth) const {
  for (std::size_t i = 0; i < parameters_.min_patient.size(); ++i) {
    const double at = mouth[static_cast<Eigen::Index>(i)];
    if (at < parameters_.min_patient[i] || at > parameters_.max_patient[i]) return false;
  }
  return true;
}

void FaceWatch::see_no_estimate(const std::string& why) {
  no_estimate_ = why;
  if (face_) refusal_ = why;
}

bool FaceWatch::begins_to_move() const { return moving_ >= kBeginsToMove; }

std::string FaceWatch::blindness(Time since, Time now) const {
  if (is_longer_than_lost(std::max(picture_came_, since), now)) {
    return fmt::format("no picture has come for {:g} s", parameters_.lost);
  }
  if (unusable_ && is_longer_than_lost(std::max(unusable_->since, since), now)) {
    return fmt::format("no picture could be used for {:g} s: {}", parameters_.lost, unusable_->why);
  }
  return {};
}

bool FaceWatch::lost(Time since) const {
  return is_longer_than_lost(std::max({known_since(since), face_at_, begins_at_}), picture_at_);
}

std::string FaceWatch::disbelief(Time since) const {
  if (!is_longer_than_lost(known_since(since), picture_at_) ||
      is_longer_than_lost(face_at_, picture_at_)) {
    return {};
  }
  const std::string& why = refusal_.empty() ? no_estimate_ : refusal_;
  return "a face is seen but not believed: " + (why.empty() ? "nobody tells where it is" : why);
}

}  // namespace armature::task::lamp_alignment
