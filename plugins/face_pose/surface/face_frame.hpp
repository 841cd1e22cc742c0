// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <array>
#include <cmath>
#include <cstddef>

#include "armature/kinds/image_view.hpp"
#include "armature/kinds/landmarks/landmarks.hpp"

namespace armature::face_pose::surface {

/// Where the features of a face are in the left picture [px].
struct Features {
  Eigen::Vector2d left_eye, right_eye, mouth;

  /// In the order of kFaceFeatures.
  const Eigen::Vector2d& operator[](std::size_t i) const {
    return i == 0 ? left_eye : i == 1 ? right_eye : mouth;
  }
  Eigen::Vector2d between_eyes() const { return 0.5 * (left_eye + right_eye); }
  Eigen::Vector2d across() const { return right_eye - left_eye; }
  Eigen::Vector2d down() const { return mouth - between_eyes(); }
};

/// A place on a face, whatever its size and pose: x across in distances of the eyes, y down in
/// distances of the eyes from the mouth; from the middle between the eyes.
struct FacePlace {
  double x, y;
};

/// An ellipse on a face.
struct FaceArea {
  FacePlace middle;
  double half_width, half_height;  // in the units of FacePlace
};

inline constexpr FaceArea kWholeFace{{0, 0.45}, 1.0, 1.1};
/// What of a flat face can be compared, too; a round one turns away there.
inline constexpr FaceArea kFlatFace{{0, 0.45}, 1.1, 1.2};

/// An eye or the mouth, and what is to be seen of it and around it.
struct FeatureArea {
  FaceFeature which;
  const char* name;
  FaceArea area;
};
inline constexpr std::array<FeatureArea, 3> kFaceFeatures{
    {{FaceFeature::left_eye, "left eye", {{-0.5, 0}, 0.32, 0.22}},
     {FaceFeature::right_eye, "right eye", {{0.5, 0}, 0.32, 0.22}},
     {FaceFeature::mouth, "mouth", {{0, 1}, 0.45, 0.28}}}};

/// The pixels of the left picture that belong to places on a face: an affine map, which a face that
/// is small before its distance is seen by.
class FaceFrame {
 public:
  explicit FaceFrame(const Features& features)
      : origin_{features.between_eyes()}, across_{features.across()}, down_{features.down()} {
    const double area = across_.x() * down_.y() - across_.y() * down_.x();
    to_x_ = Eigen::Vector2d{down_.y(), -down_.x()} / area;
    to_y_ = Eigen::Vector2d{-across_.y(), across_.x()} / area;
  }
  Eigen::Vector2d pixel(const FacePlace& place) const {
    return origin_ + place.x * across_ + place.y * down_;
  }
  /// Whether a pixel lies in an area.
  bool is_in(const FaceArea& area, double u, double v) const {
    const Eigen::Vector2d from{u - origin_.x(), v - origin_.y()};
    const double x = (to_x_.dot(from) - area.middle.x) / area.half_width;
    const double y = (to_y_.dot(from) - area.middle.y) / area.half_height;
    return x * x + y * y <= 1;
  }
  /// The rows and columns that an area takes.
  PixelBox box(const FaceArea& area) const {
    const Eigen::Vector2d middle = pixel(area.middle);
    const auto half_of = [&](int i) {
      return std::hypot(area.half_width * across_[i], area.half_height * down_[i]);
    };
    const Eigen::Vector2d half{half_of(0), half_of(1)};
    return {middle.x() - half.x(), middle.y() - half.y(), 2 * half.x(), 2 * half.y()};
  }

 private:
  Eigen::Vector2d origin_, across_, down_, to_x_, to_y_;
};

}  // namespace armature::face_pose::surface
