// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <opencv2/core.hpp>
#include <vector>

#include "armature/kinds/image_view.hpp"
#include "rectification.hpp"

namespace armature::camera::stereo_pair {

/// Where each pixel of a rectified picture lies in the camera's own one, to 1/32 px.
class RectifyingMap {
 public:
  /// Takes some 30 ms for 1280 x 720 pixels.
  RectifyingMap(const StereoCamera& rectified, const Eigen::Matrix3d& rectified_R_camera,
                const stereo::Lens& lens);

  /// Interpolates linearly; what the camera does not see is black. `raw` has the size of the
  /// rectified picture; `pixels` is resized to it.
  void rectify(const ImageView& raw, std::vector<std::uint8_t>& pixels) const;
  /// Which part of the rectified picture the camera sees, 0 to 1.
  double coverage() const { return coverage_; }

 private:
  cv::Mat pixels_, fractions_;
  double coverage_ = 0;
};

}  // namespace armature::camera::stereo_pair
