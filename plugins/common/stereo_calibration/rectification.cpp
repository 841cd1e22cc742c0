// SPDX-License-Identifier: Apache-2.0
#include "rectification.hpp"

#include <fmt/format.h>

#include <cmath>
#include <numbers>

namespace armature::stereo {
namespace {

using Eigen::Isometry3d;
using Eigen::Matrix3d;
using Eigen::Vector2d;
using Eigen::Vector3d;

constexpr double kMinBaseline = 0.001, kMaxBaseline = 10;  // [m]
constexpr double kMaxTurn = 0.2;                           // [deg]
constexpr double kMaxBaselineError = 0.02;
constexpr double kMinAlongX = 0.7;  // cosine between the baseline and the rows

double degrees(double radians) { return radians * 180 / std::numbers::pi; }
double angle_between(const Matrix3d& a, const Matrix3d& b) {
  return degrees(Eigen::AngleAxisd{a.transpose() * b}.angle());
}

Expected<void> check_baseline(double baseline) {
  if (baseline >= kMinBaseline && baseline <= kMaxBaseline) return {};
  return refuse(
      fmt::format("the cameras stand {:g} m apart, which is not between {:g} and {:g} m; "
                  "is the calibration in another unit than metres?",
                  baseline, kMinBaseline, kMaxBaseline));
}

/// The middle of what a camera sees, in the rectified picture of focal length 1. Parts of the
/// picture's rim that the lens does not reach do not count.
Expected<Vector2d> middle_of(const Lens& lens, const Matrix3d& rectified_R_camera, int width,
                             int height) {
  constexpr int kPerSide = 8, kMinReached = 8;
  Vector2d low = Vector2d::Constant(1e9), high = Vector2d::Constant(-1e9);
  int reached = 0;
  const auto include = [&](double u, double v) {
    const auto ray = lens.ray_of({u, v});
    const Vector3d direction = rectified_R_camera * ray.value_or(Vector2d::Zero()).homogeneous();
    if (!ray || direction.z() <= 0) return;
    low = low.cwiseMin(direction.hnormalized());
    high = high.cwiseMax(direction.hnormalized());
    ++reached;
  };
  for (int i = 0; i < kPerSide; ++i) {
    const double u = (width - 1.0) * i / kPerSide, v = (height - 1.0) * i / kPerSide;
    include(u, 0);
    include(width - 1.0, v);
    include(width - 1.0 - u, height - 1.0);
    include(0, height - 1.0 - v);
  }
  if (reached >= kMinReached) return Vector2d{0.5 * (low + high)};
  return refuse(
      fmt::format("the lens reaches {} of {} points of the picture's rim: its distortion "
                  "turns back before; calibrate again with the board at the rims, too",
                  reached, 4 * kPerSide));
}

Expected<Rectification> half_way(const StereoCalibration& calibration) {
  const Isometry3d& right_T_left = *calibration.right_T_left;
  const Eigen::AngleAxisd turn{right_T_left.linear()};
  const Matrix3d half = Eigen::AngleAxisd{0.5 * turn.angle(), turn.axis()}.toRotationMatrix();
  // From the left camera to the right one, in the frame half way between them.
  const Vector3d way = -(half.transpose() * right_T_left.translation());
  if (auto checked = check_baseline(way.norm()); !checked) return tl::unexpected{checked.error()};
  const Vector3d x = way.normalized();
  if (x.x() < kMinAlongX) {
    return refuse(
        fmt::format("the right camera stands at ({:.4g}, {:.4g}, {:.4g}) m before the left one, x "
                    "to the right; "
                    "{}",
                    way.x(), way.y(), way.z(),
                    x.x() < -kMinAlongX ? "exchange left and right"
                                        : "cameras that stand beside each other are needed"));
  }
  const Vector3d y = Vector3d::UnitZ().cross(x).normalized();
  Matrix3d rectified_R_half;
  rectified_R_half << x.transpose(), y.transpose(), x.cross(y).transpose();

  Rectification made{.rectified_R_left = rectified_R_half * half,
                     .rectified_R_right = rectified_R_half * half.transpose()};
  const auto& [width, height, left, right, pose, said] = calibration;
  const auto left_middle = middle_of(left, made.rectified_R_left, width, height);
  if (!left_middle) return refuse("left: " + left_middle.error().text);
  const auto right_middle = middle_of(right, made.rectified_R_right, width, height);
  if (!right_middle) return refuse("right: " + right_middle.error().text);
  const double f = 0.25 * (left.fx + left.fy + right.fx + right.fy);
  const Vector2d middle = 0.5 * (*left_middle + *right_middle);
  made.camera = {.width = width,
                 .height = height,
                 .focal_px = f,
                 .cx = 0.5 * (width - 1) - f * middle.x(),
                 .cy = 0.5 * (height - 1) - f * middle.y(),
                 .baseline_m = way.norm()};
  return made;
}

/// Whether what the file says of its rectification belongs to its R and T.
Expected<void> check_agreement(const Rectification& said, const Isometry3d& right_T_left) {
  const double turned =
      angle_between(said.rectified_R_right * right_T_left.linear(), said.rectified_R_left);
  const Vector3d way = -(said.rectified_R_right * right_T_left.translation());
  const double beside = degrees(std::atan2(way.tail<2>().norm(), way.x()));
  const double b = said.camera.baseline_m, longer = std::abs(way.norm() - b) / b;
  if (turned <= kMaxTurn && beside <= kMaxTurn && longer <= kMaxBaselineError) return {};
  return refuse(
      fmt::format("R1, R2, P1, P2 do not belong to R and T: the rotations are {:.3g} "
                  "degrees off, the baseline {:.3g} degrees and {:.3g} %; without R1, R2, "
                  "P1, P2 the rectification is made of R and T",
                  turned, beside, 100 * longer));
}

}  // namespace

Expected<Rectification> rectification_of(const StereoCalibration& calibration) {
  if (calibration.width <= 0 || calibration.height <= 0) {
    return refuse("the size of the pictures is not said; add image_width and image_height");
  }
  if (!calibration.rectification) {
    if (!calibration.right_T_left) return refuse("neither R and T nor a rectification is said");
    return half_way(calibration);
  }
  Rectification said = *calibration.rectification;
  said.camera.width = calibration.width;
  said.camera.height = calibration.height;
  if (auto checked = check_baseline(said.camera.baseline_m); !checked) {
    return tl::unexpected{checked.error()};
  }
  if (calibration.right_T_left) {
    if (auto checked = check_agreement(said, *calibration.right_T_left); !checked) {
      return tl::unexpected{checked.error()};
    }
  }
  return said;
}

std::optional<Vector2d> raw_pixel(const StereoCamera& rectified, const Matrix3d& rectified_R_camera,
                                  const Lens& lens, double max_radius, const Vector2d& pixel) {
  const Vector3d seen{(pixel.x() - rectified.cx) / rectified.focal_px,
                      (pixel.y() - rectified.cy) / rectified.focal_px, 1};
  const Vector3d direction = rectified_R_camera.transpose() * seen;
  if (direction.z() <= 0) return std::nullopt;
  const Vector2d ray = direction.hnormalized();
  if (ray.norm() > max_radius) return std::nullopt;
  return lens.project(ray);
}

}  // namespace armature::stereo
