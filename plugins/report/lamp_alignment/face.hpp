// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Geometry>
#include <algorithm>

#include "armature/kinds/target/target.hpp"

namespace armature::report::lamp_alignment {

/// A mouth and a face normal in the base frame.
struct Face {
  Eigen::Vector3d mouth = Eigen::Vector3d::Zero();    // [m]
  Eigen::Vector3d normal = Eigen::Vector3d::UnitX();  // unit
};

/// Where a face is at `when` that goes on with its rates, for 0.2 s at most: what is known of it
/// comes as often as pictures do, the arm's joints come much more often.
inline Face face_at(const TargetEstimate& known, Time when) {
  constexpr Duration kGoesOn = seconds(0.2);
  const double passed_s = to_seconds(std::clamp(when - known.stamp, Duration{0}, kGoesOn));
  return {.mouth = known.position + passed_s * known.velocity,
          .normal = (known.normal + passed_s * known.normal_rate).normalized()};
}

}  // namespace armature::report::lamp_alignment
