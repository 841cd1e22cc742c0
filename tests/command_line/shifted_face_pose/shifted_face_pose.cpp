// SPDX-License-Identifier: Apache-2.0
#include "armature/kinds/face_pose/face_pose.hpp"
#include "armature/runtime/plugins/plugin.hpp"
#include "face_pose_shifted_parameters.hpp"

namespace armature::face_pose::shifted {

/// Triangulates eyes and mouth, and moves them away.
class Shifted final : public FacePoseEstimator {
 public:
  static Expected<std::unique_ptr<FacePoseEstimator>> make(const Params& params) {
    return std::unique_ptr<FacePoseEstimator>{new Shifted{Parameters::read(params).away}};
  }

  Expected<FacePose> estimate(const FacePoseInput& input, PluginState&) override {
    const auto at = [&](FaceFeature feature) -> Eigen::Vector3d {
      const Eigen::Vector2d left = input.landmarks.left.feature(feature).point;
      const Eigen::Vector2d right = input.landmarks.right.feature(feature).point;
      return input.camera.triangulate(left, right) + Eigen::Vector3d{0, 0, away_m_};
    };
    FacePose pose;
    pose.left_eye = at(FaceFeature::left_eye);
    pose.right_eye = at(FaceFeature::right_eye);
    pose.mouth = at(FaceFeature::mouth);
    pose.normal = (pose.right_eye - pose.mouth).cross(pose.left_eye - pose.mouth).normalized();
    return pose;
  }

 private:
  explicit Shifted(double away_m) : away_m_{away_m} {}

  double away_m_;
};

}  // namespace armature::face_pose::shifted

ARMATURE_PLUGIN(armature::face_pose::shifted::Shifted);
