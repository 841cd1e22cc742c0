// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <limits>
#include <optional>
#include <utility>
#include <vector>

#include "armature/scene/photo.hpp"
#include "armature/scene/surface.hpp"

namespace armature::scene {

/// What is held in front of a face.
enum class Occluder {
  none,
  instrument_over_mouth,  // a metal rod with a round head
  hand_over_mouth,        // four fingers across the lips, a thumb and a palm beside them
  hand_over_eye,          // the same across the picture's right eye
  mask,                   // pleated, over mouth and nose; stands out by 32 mm
};

/// An occluder's bodies in the frame of the face (origin at the mouth, z into it), all of them in
/// front of it: z < 0.
class ARMATURE_EXPORT OccluderBody {
 public:
  /// Sized for the face of the photo: as an adult's whose eyes are 63 mm apart.
  OccluderBody(Occluder which, const Photo& photo);

  bool empty() const { return capsules_.empty() && !mask_; }
  /// The grey value that a ray meets, 0 to 255; nothing when it passes. Real-time safe.
  std::optional<double> grey(const Ray& ray) const;
  /// The corners of the box along the face's axes that holds all of it [m]; for a body that is
  /// not empty.
  std::pair<Eigen::Vector3d, Eigen::Vector3d> box() const;

 private:
  struct Capsule {
    Eigen::Vector3d from, to;  // [m] the ends of its axis
    double radius;
    bool is_metal;
  };
  struct Ellipsoid {
    Eigen::Vector3d centre, half_axes;
  };
  struct Hit {
    double t = std::numeric_limits<double>::infinity();
    Eigen::Vector3d normal;
  };

  void add_rod(double scale);
  void add_hand(const Eigen::Vector3d& middle, double scale);
  static void meet(const Capsule& capsule, const Ray& ray, Hit& nearest);
  static void meet(const Ellipsoid& mask, const Ray& ray, Hit& nearest);

  double texture_scale_ = 1;  // of lengths, to those of an adult's face
  std::vector<Capsule> capsules_;
  std::optional<Ellipsoid> mask_;
};

}  // namespace armature::scene
