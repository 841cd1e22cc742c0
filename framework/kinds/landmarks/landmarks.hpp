// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <array>
#include <optional>
#include <string_view>

#include "armature/kinds/landmarks/image_view.hpp"
#include "armature/kinds/made_for_robot.hpp"
#include "armature/values/expected.hpp"

namespace armature {

/// Axis-aligned box in pixels.
struct PixelBox {
  double left = 0, top = 0, width = 0, height = 0;
};

/// The 68 landmarks of iBUG 300-W in one image, 0-based order, [px].
struct FaceLandmarks {
  static constexpr int kCount = 68;
  std::array<Eigen::Vector2d, kCount> points;
  PixelBox box;
  double score = 0;           // of the detector
  double mean_intensity = 0;  // of the image inside the box, 0..255
};

struct StereoLandmarks {
  FaceLandmarks left, right;
};

/// Finds the landmarks of one face in a rectified stereo pair.
class LandmarkFinder {
 public:
  static constexpr std::string_view kKind = "landmarks";
  static constexpr int kKindVersion = 1;
  using Factory = MadeFromParams<LandmarkFinder>;

  /// Where the face was last: the caller owns it; value-initialised means "search everywhere".
  struct State {
    std::optional<PixelBox> left, right;
  };

  virtual ~LandmarkFinder() = default;
  /// Landmarks in both images, or why not ("no face in the left image"). Not const: a detector may
  /// keep scratch memory, never knowledge. May allocate.
  virtual Expected<StereoLandmarks> find(const ImageView& left, const ImageView& right,
                                         State& state) = 0;
};

}  // namespace armature
