// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <optional>

#include "armature/scene/photo.hpp"

namespace armature::scene {

/// A ray in the face's frame: points origin + t direction, t > 0. The frame: origin at the mouth, x
/// to the photo's right as seen by who looks at it, y down, z into the face.
struct Ray {
  Eigen::Vector3d origin, direction;
};

/// What the photo is glued to. It touches the plane z = 0 at the mouth.
struct ARMATURE_EXPORT Surface {
  enum class Shape {
    plane,
    cylinder,  // its axis is parallel to y and `radius_m` behind the mouth
    sphere,    // its centre is `radius_m` behind the mouth
  };
  Shape shape = Shape::plane;
  double radius_m = 0.09;

  /// Where a place of the flat photo, [m] from the mouth, comes to lie [m]. On the cylinder lengths
  /// along x and along y stay; on the sphere the lengths and directions from the mouth.
  Eigen::Vector3d point(const Eigen::Vector2d& flat) const;
  /// The place of the flat photo that the ray meets first from outside; nothing when it passes, or
  /// when it comes from behind.
  std::optional<Eigen::Vector2d> met_by(const Ray& ray) const;
};

/// Eyes and mouth [m] in one frame. "left" is the picture's left.
struct ARMATURE_EXPORT FacePoints {
  Eigen::Vector3d left_eye, right_eye, mouth;

  /// The unit normal of the plane through all three, out of the face (Jiang et al. 2021,
  /// (12)-(15)).
  Eigen::Vector3d normal() const;
  /// The points in the frame a.
  FacePoints in(const Eigen::Isometry3d& a_T_points) const;
};

/// In the face's frame.
ARMATURE_EXPORT FacePoints face_points(const Photo& photo, const Surface& surface);

}  // namespace armature::scene
