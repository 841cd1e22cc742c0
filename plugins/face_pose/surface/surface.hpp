// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <memory>
#include <vector>

#include "armature/kinds/face_pose/face_pose.hpp"
#include "armature/kinds/face_pose/stereo_points.hpp"
#include "face_fit.hpp"
#include "face_pose_surface_parameters.hpp"
#include "frontal_view.hpp"

namespace armature::face_pose::surface {

/// Face pose from a surface that is aligned with the pixels of both pictures (see README).
class Surface final : public FacePoseEstimator {
 public:
  explicit Surface(const Parameters& parameters) : parameters_{parameters} {}
  static Expected<std::unique_ptr<FacePoseEstimator>> make(const Params& params);

  Expected<FacePose> estimate(const FacePoseInput& input, PluginState& state) override;

 private:
  /// The features of one face in the left picture, their sigmas [px], and each one's own surface.
  struct Located {
    Features at;
    std::array<double, 3> sigma;
    std::array<Alignment, 3> own;
    std::array<double, 3> relief{};  // [px] how well its disparity is known for what bulges there
    bool is_unsettled = false;       // another look may settle where they are
    bool is_last_look = false;
  };

  static Expected<std::vector<DisparitySurface>> starts_of(const Features& left,
                                                           const Features& right,
                                                           const PluginState& state);
  Expected<FacePose> look(const FacePoseInput& input, const std::vector<DisparitySurface>& starts,
                          Alignment& aligned, Located& located);
  Expected<void> see_features(const Alignment& aligned, const StereoCamera& camera,
                              Located& located);
  double come_near(const FaceArea& area, const Eigen::Vector2d& at, Alignment& own);
  Expected<void> find_again(const FacePoseInput& input, const Alignment& aligned, Located& located);
  FacePose pose(const Alignment& aligned, const StereoCamera& camera, const Located& located) const;

  Parameters parameters_;
  FaceFit fit_;
  FrontalView view_;
};

}  // namespace armature::face_pose::surface
