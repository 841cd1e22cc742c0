// SPDX-License-Identifier: Apache-2.0
#include "smoothness.hpp"

#include <algorithm>

namespace armature::report::implant {

void Smoothness::see(Time stamp, const Eigen::Vector3d& omega) {
  if (last_ && stamp <= last_->stamp) return;
  if (last_) {
    const double dt = to_seconds(stamp - last_->stamp);
    const Eigen::Vector3d acceleration = (omega - last_->omega) / dt;
    total_ += dt * (omega + last_->omega).norm() / 2;
    peak_acceleration_ = std::max(peak_acceleration_, acceleration.norm());
    if (acceleration_) peak_jump_ = std::max(peak_jump_, (acceleration - *acceleration_).norm());
    acceleration_ = acceleration;
  }
  peak_velocity_ = std::max(peak_velocity_, omega.norm());
  last_ = Sample{stamp, omega};
}

double Smoothness::acceleration_jump_of_peak() const {
  return peak_acceleration_ > 0 ? peak_jump_ / peak_acceleration_ : 0;
}

}  // namespace armature::report::implant
