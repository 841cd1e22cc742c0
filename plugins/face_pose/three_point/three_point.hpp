// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>

#include "armature/kinds/face_pose/face_pose.hpp"
#include "face_pose_three_point_parameters.hpp"

namespace armature::face_pose::three_point {

/// Face pose from three triangulated features: both eye centres and the mouth (Jiang et al. 2021,
/// section 2; see README).
class ThreePoint final : public FacePoseEstimator {
 public:
  explicit ThreePoint(const Parameters& parameters) : parameters_{parameters} {}
  static Expected<std::unique_ptr<FacePoseEstimator>> make(const Params& params);

  Expected<FacePose> estimate(const FacePoseInput& input) override;

 private:
  Expected<Eigen::Vector3d> triangulate(const char* feature, const StereoCamera& camera,
                                        const Eigen::Vector2d& left,
                                        const Eigen::Vector2d& right) const;

  Parameters parameters_;
};

}  // namespace armature::face_pose::three_point
