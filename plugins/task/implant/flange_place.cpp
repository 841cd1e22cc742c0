// SPDX-License-Identifier: Apache-2.0
#include "flange_place.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace armature::task::implant {

void FlangePlace::see(const Sighting& sighting, const Eigen::Isometry3d& base_T_flange, Time now,
                      const Stillness& still) {
  if (still.is_left(base_T_flange_, base_T_flange)) {
    average_.clear();
    still_since_ = now;
    base_T_flange_ = base_T_flange;
  }
  if (sighting.tracker_T_body && sighting.stamp >= still_since_) {
    average_.add(*sighting.tracker_T_body);
  }
}

std::optional<std::string> FlangePlace::defect(std::span<const Eigen::Vector3d> points) const {
  constexpr double kScatters = 4;  // rms: one mean in some thousand is farther off
  const Eigen::Isometry3d base_T_seen = hand_eye_.base_T_tracker * average_.mean();
  for (const Eigen::Vector3d& point : points) {
    const Eigen::Vector3d on_body = base_T_body().inverse() * point;
    const double off_m = (base_T_seen * on_body - point).norm();
    const double scatter_m = std::hypot(average_.error_at(on_body).rms_m, hand_eye_.residual_rms_m);
    const double allowed_m = std::max(parameters_.max_flange_error, kScatters * scatter_m);
    if (off_m <= allowed_m) continue;
    return fmt::format(
        "the tracker sees the body on the flange {:.2f} mm off where the hand-eye calibration has "
        "it, {:.2g} mm are allowed: the tracker or the body has moved since; calibrate again",
        1e3 * off_m, 1e3 * allowed_m);
  }
  return std::nullopt;
}

}  // namespace armature::task::implant
