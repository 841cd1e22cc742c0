// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>

#include "armature/kinds/face_pose/face_pose.hpp"

namespace armature {

/// Face pose from three triangulated features: both eye centres and the mouth (Jiang et al. 2021,
/// section 2; see README).
class ThreePoint final : public FacePoseEstimator {
 public:
  struct Settings {
    double landmark_sigma_px = 0.3;          // of one feature in one image
    double nearest_m = 0.2, farthest_m = 2;  // depth that is believed
    double most_row_mismatch_px = 6;
    double least_eye_distance_m = 0.03, most_eye_distance_m = 0.15;
  };

  explicit ThreePoint(const Settings& settings) : settings_{settings} {}
  static Expected<std::unique_ptr<FacePoseEstimator>> make(const Params& params);

  Expected<FacePose> estimate(const FacePoseInput& input) override;

 private:
  Expected<Eigen::Vector3d> triangulate(const char* feature, const StereoCamera& camera,
                                        const Eigen::Vector2d& left,
                                        const Eigen::Vector2d& right) const;

  Settings settings_;
};

}  // namespace armature
