// SPDX-License-Identifier: Apache-2.0
#include "armature/scene/occluder.hpp"

#include <algorithm>
#include <cmath>

#include "armature/scene/drawing.hpp"

namespace armature::scene {
namespace {

using Eigen::Vector3d;

constexpr double kAdultEyeDistance = 0.063;  // [m]

/// How steeply the surface looks at who sees it: 1 straight, 0 from the side.
double facing(const Vector3d& normal, const Vector3d& direction) {
  return std::max(-normal.dot(direction.normalized()), 0.0);
}

double skin_grey(const Vector3d& at_mm, double facing) {
  static const SkinTexture texture{17};
  const Point place{at_mm.x() + 0.4 * at_mm.z(), at_mm.y() + 0.3 * at_mm.z()};
  return 90 + 85 * facing + 9 * texture(place, 1.3, 1) + 8 * texture(place, 4.0, 2) +
         6 * texture(place, 11.0, 3);
}

/// Turned metal: bright along the line that mirrors the light, dark aside, with fine grooves.
double metal_grey(const Vector3d& at_mm, double facing) {
  static const SkinTexture texture{23};
  const double mirrored = std::pow(facing, 12);
  return 60 + 50 * facing + 140 * mirrored +
         12 * texture({at_mm.x() + at_mm.z(), at_mm.y()}, 0.9, 1) +
         9 * texture({at_mm.x(), at_mm.y() + at_mm.z()}, 5.0, 2);
}

/// Pale cloth with pleats 9 mm apart.
double cloth_grey(const Vector3d& at_mm, double facing) {
  static const SkinTexture texture{31};
  const double pleat = std::abs(at_mm.y() / 9 - std::round(at_mm.y() / 9));
  const double fold = pleat < 0.07 ? 45.0 : 0.0;
  return 130 + 80 * facing - fold + 5 * texture({at_mm.x(), at_mm.y()}, 1.1, 1) +
         6 * texture({at_mm.x(), at_mm.y()}, 7.0, 2);
}

}  // namespace

OccluderBody::OccluderBody(Occluder which, const Photo& photo) {
  const double eye_distance = (photo.right_eye - photo.left_eye).norm() * photo.m_per_px;
  const double scale = eye_distance / kAdultEyeDistance;
  texture_scale_ = 1 / scale;
  const Eigen::Vector2d eye = (photo.right_eye - photo.mouth) * photo.m_per_px;
  switch (which) {
    case Occluder::none: break;
    case Occluder::instrument_over_mouth: add_rod(scale); break;
    case Occluder::hand_over_mouth: add_hand(Vector3d{0, 0, 0}, scale); break;
    case Occluder::hand_over_eye: add_hand(Vector3d{eye.x(), eye.y(), 0}, scale); break;
    case Occluder::mask:
      mask_ = Ellipsoid{scale * Vector3d{0, -0.006, 0}, scale * Vector3d{0.060, 0.047, 0.032}};
      break;
  }
}

void OccluderBody::add_rod(double scale) {
  const auto at = [&](double x, double y, double z) -> Vector3d {
    return scale * Vector3d{x, y, z};
  };
  capsules_.push_back({at(-0.012, -0.004, -0.016), at(0.16, 0.10, -0.09), 0.005 * scale, true});
  capsules_.push_back({at(-0.014, -0.004, -0.016), at(0.006, 0.004, -0.018), 0.011 * scale, true});
}

// Fingers that reach across `middle` from the right, 16 mm apart; they lie on the face.
void OccluderBody::add_hand(const Vector3d& middle, double scale) {
  const auto at = [&](double x, double y, double z) -> Vector3d {
    return middle + scale * Vector3d{x, y, z};
  };
  const double reach[4] = {-0.028, -0.036, -0.033, -0.020};
  for (int finger = 0; finger < 4; ++finger) {
    const double y = -0.024 + 0.016 * finger;
    capsules_.push_back(
        {at(reach[finger], y, -0.011), at(0.062, 1.1 * y, -0.020), 0.0085 * scale, false});
  }
  capsules_.push_back({at(0.070, -0.020, -0.030), at(0.074, 0.026, -0.030), 0.020 * scale, false});
  capsules_.push_back({at(0.055, 0.036, -0.026), at(0.030, 0.046, -0.012), 0.010 * scale, false});
  capsules_.push_back({at(0.085, 0.012, -0.034), at(0.150, 0.060, -0.060), 0.024 * scale, false});
}

// The nearest of its round side and of its two ends; Ericson, Real-Time Collision Detection, 5.3.7,
// with the equation of the side solved for the distance from the axis.
void OccluderBody::meet(const Capsule& capsule, const Ray& ray, Hit& nearest) {
  const Vector3d axis = capsule.to - capsule.from, from = ray.origin - capsule.from;
  const double length2 = axis.squaredNorm(), r2 = capsule.radius * capsule.radius;
  const auto take = [&](double t, const Vector3d& axis_point) {
    if (t <= 0 || t >= nearest.t) return;
    nearest.t = t;
    nearest.normal = (ray.origin + t * ray.direction - axis_point) / capsule.radius;
  };
  const double dd = ray.direction.squaredNorm();
  const double along_d = ray.direction.dot(axis), along_f = from.dot(axis);
  const double a = dd - along_d * along_d / length2;
  const double b = from.dot(ray.direction) - along_f * along_d / length2;
  const double c = from.squaredNorm() - along_f * along_f / length2 - r2;
  const double discriminant = b * b - a * c;
  if (discriminant < 0) return;  // past the endless cylinder, so past both ends, too
  if (a > 0) {
    const double t = (-b - std::sqrt(discriminant)) / a;
    const double share = (along_f + t * along_d) / length2;
    if (share >= 0 && share <= 1) return take(t, capsule.from + share * axis);
  }
  for (const Vector3d& end : {capsule.from, capsule.to}) {
    const Vector3d to_end = ray.origin - end;
    const double eb = to_end.dot(ray.direction);
    const double end_discriminant = eb * eb - dd * (to_end.squaredNorm() - r2);
    if (end_discriminant >= 0) take((-eb - std::sqrt(end_discriminant)) / dd, end);
  }
}

// Only the half in front of the face is there: an entry behind it is none.
void OccluderBody::meet(const Ellipsoid& mask, const Ray& ray, Hit& nearest) {
  const Vector3d o = (ray.origin - mask.centre).cwiseQuotient(mask.half_axes);
  const Vector3d d = ray.direction.cwiseQuotient(mask.half_axes);
  const double a = d.squaredNorm(), b = o.dot(d), c = o.squaredNorm() - 1;
  const double discriminant = b * b - a * c;
  if (discriminant < 0) return;
  const double t = (-b - std::sqrt(discriminant)) / a;
  const Vector3d at = ray.origin + t * ray.direction;
  if (t <= 0 || t >= nearest.t || at.z() >= 0) return;
  nearest.t = t;
  nearest.normal =
      (at - mask.centre).cwiseQuotient(mask.half_axes.cwiseProduct(mask.half_axes)).normalized();
}

std::optional<double> OccluderBody::grey(const Ray& ray) const {
  Hit nearest;
  bool is_metal = false;
  for (const Capsule& capsule : capsules_) {
    const double before = nearest.t;
    meet(capsule, ray, nearest);
    if (nearest.t < before) is_metal = capsule.is_metal;
  }
  if (mask_) meet(*mask_, ray, nearest);
  if (std::isinf(nearest.t)) return std::nullopt;
  const Vector3d at_mm = 1e3 * texture_scale_ * (ray.origin + nearest.t * ray.direction);
  const double seen = facing(nearest.normal, ray.direction);
  const double grey = mask_      ? cloth_grey(at_mm, seen)
                      : is_metal ? metal_grey(at_mm, seen)
                                 : skin_grey(at_mm, seen);
  return std::clamp(grey, 0.0, 255.0);
}

std::pair<Vector3d, Vector3d> OccluderBody::box() const {
  if (mask_) {
    Vector3d high = mask_->centre + mask_->half_axes;
    high.z() = 0;
    return {mask_->centre - mask_->half_axes, high};
  }
  Vector3d low = capsules_.front().from, high = low;
  for (const Capsule& capsule : capsules_) {
    const Vector3d around = Vector3d::Constant(capsule.radius);
    low = low.cwiseMin(capsule.from.cwiseMin(capsule.to) - around);
    high = high.cwiseMax(capsule.from.cwiseMax(capsule.to) + around);
  }
  return {low, high};
}

}  // namespace armature::scene
