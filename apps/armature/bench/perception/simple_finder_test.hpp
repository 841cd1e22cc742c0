// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cmath>
#include <vector>

#include "armature/kinds/detector/detector.hpp"
#include "armature/kinds/face_pose/face_pose.hpp"
#include "armature/kinds/landmarks/landmarks.hpp"
#include "bench/perception/cases.hpp"

// Plugins that find the drawn face of a frontal picture without looking at faces: the photo's edges
// stand out from one grey.
namespace armature::bench {

inline constexpr double kBackground = 250;  // brighter than any photo

/// A frontal case whose photo's edges can be seen.
inline PerceptionCase frontal_case(double x, double y, double z) {
  PerceptionCase one;
  one.group = "frontal";
  one.camera = {
      .width = 640, .height = 720, .focal_px = 914, .cx = 319.5, .cy = 359.5, .baseline_m = 0.06};
  one.imaging = {.noise = 0, .blur_px = 0, .background = kBackground};
  one.left_T_face = Eigen::Isometry3d{Eigen::Translation3d{x, y, z}};
  one.left_shows = one.right_shows = one.left_T_face;
  return one;
}

/// The box around all that differs from the first pixel.
class EdgeDetector : public FaceDetector {
 public:
  Expected<std::vector<DetectedFace>> detect(const ImageView& image, const SearchRegion&) override {
    int left = image.width, right = -1, top = image.height, bottom = -1;
    for (int v = 0; v < image.height; ++v) {
      for (int u = 0; u < image.width; ++u) {
        const int grey =
            image.data[static_cast<std::size_t>(v) * image.stride + static_cast<std::size_t>(u)];
        if (std::abs(grey - image.data[0]) < 4) continue;
        left = std::min(left, u);
        right = std::max(right, u);
        top = std::min(top, v);
        bottom = std::max(bottom, v);
      }
    }
    ++asked;
    if (right < left) return std::vector<DetectedFace>{};
    return std::vector<DetectedFace>{
        {.box = {left - 0.5, top - 0.5, right - left + 1.0, bottom - top + 1.0}, .score = 1}};
  }
  int asked = 0;
};

/// Eyes and mouth of the usual face at their places in the photo's box, the mouth `mouth_low_mm`
/// too low.
class BoxFinder : public LandmarkFinder {
 public:
  explicit BoxFinder(double mouth_low_mm) : mouth_low_mm_{mouth_low_mm} {}
  LandmarkScheme scheme() const override { return LandmarkScheme::five; }
  Expected<std::vector<Landmark>> find(const ImageView&, const PixelBox& box) override {
    // The usual face is drawn on 270 x 330 mm, its middle between the eyes 135 right and 140 down.
    const auto at = [&](double x_mm, double y_mm) {
      return Landmark{.point = {box.left + (x_mm + 135) / 270 * box.width,
                                box.top + (y_mm + 140) / 330 * box.height},
                      .sigma = 0.3};
    };
    const double mouth = 65 + mouth_low_mm_;
    return std::vector<Landmark>{at(-31.5, 0), at(31.5, 0), at(0, 36), at(-20, mouth),
                                 at(20, mouth)};
  }

 private:
  double mouth_low_mm_;
};

}  // namespace armature::bench
