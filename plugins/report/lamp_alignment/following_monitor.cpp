// SPDX-License-Identifier: Apache-2.0
#include "following_monitor.hpp"

#include <algorithm>
#include <cmath>

#include "face.hpp"

namespace armature::report::lamp_alignment {
namespace {

constexpr Duration kTimeToComeUp = seconds(1);
constexpr Duration kOldTruth = seconds(0.2);

}  // namespace

void FollowingMonitor::see_truth(const TargetEstimate& truth) {
  truth_ = truth;
  const bool moves = !truth.velocity.isZero() || !truth.normal_rate.isZero();
  if (!moves) return moves_since_.reset();
  if (!moves_since_) moves_since_ = truth.stamp;
}

void FollowingMonitor::see_lamp(const Eigen::Vector3d& center, const Eigen::Vector3d& light,
                                double asked_m, Time stamp) {
  if (!has_held_ || !moves_since_ || stamp - *moves_since_ < kTimeToComeUp) return;
  if (stamp < truth_->stamp || stamp - truth_->stamp > kOldTruth) return;
  const Face truth = face_at(*truth_, stamp);
  const Eigen::Vector3d way = truth.mouth - center;
  const FollowingError is{
      .spot_m = way.cross(light).norm(),
      .distance_m = std::abs(way.norm() - asked_m),
      .angle_rad = std::atan2(light.cross(-truth.normal).norm(), light.dot(-truth.normal))};
  if (!worst_) worst_.emplace();
  worst_->spot_m = std::max(worst_->spot_m, is.spot_m);
  worst_->distance_m = std::max(worst_->distance_m, is.distance_m);
  worst_->angle_rad = std::max(worst_->angle_rad, is.angle_rad);
}

}  // namespace armature::report::lamp_alignment
