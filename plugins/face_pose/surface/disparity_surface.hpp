// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <cmath>

#include "armature/robot/geometry/stereo_camera.hpp"

namespace armature::face_pose::surface {

/// A surface before a rectified stereo pair, as the disparity d(u, v) [px] of each pixel of the
/// left picture: a polynomial of x = (u - middle.u) / reach and y = (v - middle.v) / reach. A plane
/// has a disparity that is linear in u and v exactly (Z = f b / d), so that its polynomial ends
/// after three terms.
struct DisparitySurface {
  static constexpr int kPlane = 3, kQuadric = 6;
  using Terms = Eigen::Matrix<double, kQuadric, 1>;
  using Covariance = Eigen::Matrix<double, kQuadric, kQuadric>;

  Eigen::Vector2d middle = Eigen::Vector2d::Zero();  // [px]
  double reach = 1;                                  // [px]
  Terms c = Terms::Zero();                           // [px] of 1, x, y, x2, x y, y2

  Eigen::Vector2d local(const Eigen::Vector2d& pixel) const { return (pixel - middle) / reach; }
  static Terms terms(const Eigen::Vector2d& local) {
    const double x = local.x(), y = local.y();
    return (Terms{} << 1, x, y, x * x, x * y, y * y).finished();
  }
  double at(const Eigen::Vector2d& pixel) const { return c.dot(terms(local(pixel))); }
  /// [px2] of the disparity at `pixel`; `covariance`: of the terms.
  double variance(const Eigen::Vector2d& pixel, const Covariance& covariance) const {
    const Terms at = terms(local(pixel));
    return at.dot(covariance * at);
  }
  /// The plane that touches the surface at `pixel`.
  DisparitySurface tangent(const Eigen::Vector2d& pixel) const {
    const Eigen::Vector2d p = local(pixel);
    DisparitySurface plane{.middle = middle, .reach = reach};
    plane.c[1] = c[1] + 2 * c[3] * p.x() + c[4] * p.y();
    plane.c[2] = c[2] + c[4] * p.x() + 2 * c[5] * p.y();
    plane.c[0] = at(pixel) - plane.c[1] * p.x() - plane.c[2] * p.y();
    return plane;
  }
  /// [px] by which it is nearer at `reach` from the middle than its tangent there, in the direction
  /// where it is that most; negative: it bulges in all directions, as faces do.
  double hollowness() const {
    const double mean = 0.5 * (c[3] + c[5]);
    return mean + std::hypot(0.5 * (c[3] - c[5]), 0.5 * c[4]);
  }
  bool is_plane() const { return c.tail<3>().isZero(); }

  /// The point of the surface that the left camera sees at `pixel` [m].
  Eigen::Vector3d point(const Eigen::Vector2d& pixel, const StereoCamera& camera) const {
    return camera.triangulate(pixel, {pixel.x() - at(pixel), pixel.y()});
  }
  /// The unit normal of the plane, towards the camera. With d = a u + b v + c about the principal
  /// point and Z d = f b': (a f, b f, c) . (X, Y, Z) = f b', b' the baseline.
  Eigen::Vector3d plane_normal(const StereoCamera& camera) const {
    return -(across(camera) * c.head<3>()).normalized();
  }
  /// Its derivative by the plane's three terms.
  Eigen::Matrix3d plane_normal_derivative(const StereoCamera& camera) const {
    const Eigen::Vector3d normal = plane_normal(camera);
    return -(Eigen::Matrix3d::Identity() - normal * normal.transpose()) * across(camera) /
           (across(camera) * c.head<3>()).norm();
  }

 private:
  /// (a f, b f, c) of the plane's three terms.
  Eigen::Matrix3d across(const StereoCamera& camera) const {
    const double f = camera.focal_px / reach;
    const Eigen::Vector2d axis = local({camera.cx, camera.cy});
    return (Eigen::Matrix3d{} << 0, f, 0, 0, 0, f, 1, axis.x(), axis.y()).finished();
  }
};

}  // namespace armature::face_pose::surface
