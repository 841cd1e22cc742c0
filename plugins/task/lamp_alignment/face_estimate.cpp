// SPDX-License-Identifier: Apache-2.0
#include "face_estimate.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

#include "armature/robot/geometry/rotation_vector.hpp"

namespace armature::task::lamp_alignment {

FaceEstimate FaceEstimate::at(Time time) const {
  const double passed_s = to_seconds(time - stamp);
  const Eigen::Quaterniond turn = rotation_of(passed_s * angular_velocity());
  return {.stamp = time,
          .mouth = mouth + passed_s * velocity,
          .normal = turn * normal,
          .velocity = velocity,
          .normal_rate = turn * normal_rate,
          .measurements = measurements};
}

bool FaceBand::left_by(const FaceEstimate& a, const FaceEstimate& b) const {
  if ((a.mouth - b.mouth).norm() > position_m) return true;
  const double angle = std::atan2(a.normal.cross(b.normal).norm(), a.normal.dot(b.normal));
  return angle > angle_rad;
}

void FaceAverage::add(const FaceEstimate& estimate) {
  estimates_.push_back(estimate);
  if (estimates_.size() > capacity_) estimates_.pop_front();
}

FaceEstimate FaceAverage::mean(std::size_t count) const {
  const std::size_t used = std::min(count, estimates_.size());
  FaceEstimate mean{.stamp = estimates_.back().stamp,
                    .mouth = Eigen::Vector3d::Zero(),
                    .normal = Eigen::Vector3d::Zero()};
  for (auto it = estimates_.end() - static_cast<std::ptrdiff_t>(used); it != estimates_.end();
       ++it) {
    mean.mouth += it->mouth;
    mean.normal += it->normal;
  }
  mean.mouth /= static_cast<double>(used);
  mean.normal.normalize();
  return mean;
}

}  // namespace armature::task::lamp_alignment
