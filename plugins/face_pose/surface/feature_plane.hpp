// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/LU>
#include <algorithm>

#include "disparity_surface.hpp"
#include "face_frame.hpp"

namespace armature::face_pose::surface {

/// The plane through three features; `disparities` [px]: theirs, in the order of kFaceFeatures. Not
/// finite for features in one line.
inline DisparitySurface plane_through(const Features& features,
                                      const Eigen::Vector3d& disparities) {
  DisparitySurface plane{.middle = features.between_eyes() + 0.45 * features.down(),
                         .reach = std::max(features.across().norm(), features.down().norm())};
  Eigen::Matrix3d terms;
  for (std::size_t i = 0; i < kFaceFeatures.size(); ++i) {
    terms.row(static_cast<Eigen::Index>(i)) << 1, plane.local(features[i]).transpose();
  }
  plane.c.head<3>() = terms.partialPivLu().solve(disparities);
  return plane;
}

}  // namespace armature::face_pose::surface
