// SPDX-License-Identifier: Apache-2.0
#include "face_estimate.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <vector>

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

FaceEstimate FaceAverage::median(std::size_t count) const {
  const auto used = newest(count);
  std::vector<double> sorted(used.size());
  const auto median_of = [&](Eigen::Vector3d FaceEstimate::*vector, int axis) {
    std::ranges::transform(used, sorted.begin(),
                           [&](const FaceEstimate& e) { return (e.*vector)[axis]; });
    const auto middle = sorted.begin() + static_cast<std::ptrdiff_t>(sorted.size() / 2);
    std::ranges::nth_element(sorted, middle);
    return *middle;
  };
  FaceEstimate median{.stamp = estimates_.back().stamp};
  for (int axis = 0; axis < 3; ++axis) {
    median.mouth[axis] = median_of(&FaceEstimate::mouth, axis);
    median.normal[axis] = median_of(&FaceEstimate::normal, axis);
  }
  median.normal.normalize();
  return median;
}

FaceEstimate FaceAverage::mean(std::size_t count, const FaceBand& band) const {
  const FaceEstimate middle = median(count);
  FaceEstimate mean{
      .stamp = middle.stamp, .mouth = Eigen::Vector3d::Zero(), .normal = Eigen::Vector3d::Zero()};
  int used = 0;
  for (const FaceEstimate& estimate : newest(count)) {
    if (band.left_by(estimate, middle)) continue;
    mean.mouth += estimate.mouth;
    mean.normal += estimate.normal;
    ++used;
  }
  if (used == 0) return middle;
  mean.mouth /= used;
  mean.normal.normalize();
  return mean;
}

bool FaceAverage::have_left(std::size_t count, const FaceBand& band,
                            const FaceEstimate& face) const {
  return estimates_.size() >= count &&
         std::ranges::all_of(newest(count),
                             [&](const FaceEstimate& e) { return band.left_by(e, face); });
}

}  // namespace armature::task::lamp_alignment
