// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <array>
#include <optional>
#include <string>
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
  /// Landmarks in both images, or why not ("no face in the left image"). What is not found is
  /// forgotten in the state. Not const: a detector may keep scratch memory, never knowledge. May
  /// allocate.
  virtual Expected<StereoLandmarks> find(const ImageView& left, const ImageView& right,
                                         State& state) = 0;
};

/// nullopt, or why the views are no stereo pair: no pixels, rows that overlap, two sizes. The first
/// line of every finder.
inline std::optional<std::string> invalid_input(const ImageView& left, const ImageView& right) {
  for (const ImageView* view : {&left, &right}) {
    if (view->data == nullptr || view->width <= 0 || view->height <= 0) return "empty image";
    if (view->stride < static_cast<std::size_t>(view->width)) {
      return "an image of " + std::to_string(view->width) + " pixels in rows of " +
             std::to_string(view->stride);
    }
  }
  if (left.width == right.width && left.height == right.height) return std::nullopt;
  const auto size = [](const ImageView& view) {
    return std::to_string(view.width) + " x " + std::to_string(view.height);
  };
  return "the left image is " + size(left) + " pixels, the right one " + size(right);
}

}  // namespace armature
