// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>

#include "armature/kinds/face_pose/face_pose.hpp"
#include "armature/kinds/face_pose/stereo_points.hpp"
#include "face_pose_three_point_parameters.hpp"

namespace armature::face_pose::three_point {

/// Face pose from three triangulated features: both eye centres and the mouth (Jiang et al. 2021,
/// section 2; see README).
class ThreePoint final : public FacePoseEstimator {
 public:
  explicit ThreePoint(const Parameters& parameters) : parameters_{parameters} {}
  static Expected<std::unique_ptr<FacePoseEstimator>> make(const Params& params);

  Expected<FacePose> estimate(const FacePoseInput& input, PluginState& state) override;

 private:
  Expected<StereoPoint> triangulate(FaceFeature feature, const FacePoseInput& input) const;

  Parameters parameters_;
};

}  // namespace armature::face_pose::three_point
