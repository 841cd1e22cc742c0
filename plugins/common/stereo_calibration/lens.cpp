// SPDX-License-Identifier: Apache-2.0
#include "lens.hpp"

#include <Eigen/LU>

namespace armature::stereo {
namespace {

struct Radial {
  double factor;  // of x and y
  double slope;   // d factor / d r^2
  bool finite;    // its denominator is above 0
};

Radial radial_at(const std::array<double, 8>& k, double r2) {
  const double over = 1 + r2 * (k[0] + r2 * (k[1] + r2 * k[4]));
  const double under = 1 + r2 * (k[5] + r2 * (k[6] + r2 * k[7]));
  const double over_slope = k[0] + r2 * (2 * k[1] + r2 * 3 * k[4]);
  const double under_slope = k[5] + r2 * (2 * k[6] + r2 * 3 * k[7]);
  return {.factor = over / under,
          .slope = (over_slope * under - over * under_slope) / (under * under),
          .finite = under > 0};
}

Eigen::Matrix2d slope_at(const std::array<double, 8>& k, const Eigen::Vector2d& ray) {
  const Radial radial = radial_at(k, ray.squaredNorm());
  const double x = ray.x(), y = ray.y(), p1 = k[2], p2 = k[3];
  Eigen::Matrix2d slope = 2 * radial.slope * ray * ray.transpose();
  slope.diagonal().array() += radial.factor;
  const double mixed = 2 * (p1 * x + p2 * y);
  slope += (Eigen::Matrix2d{} << 2 * p1 * y + 6 * p2 * x, mixed, mixed, 6 * p1 * y + 2 * p2 * x)
               .finished();
  return slope;
}

}  // namespace

Eigen::Vector2d Lens::distort(const Eigen::Vector2d& ray) const {
  const double x = ray.x(), y = ray.y(), r2 = ray.squaredNorm();
  const double p1 = distortion[2], p2 = distortion[3];
  const double factor = radial_at(distortion, r2).factor;
  return {x * factor + 2 * p1 * x * y + p2 * (r2 + 2 * x * x),
          y * factor + p1 * (r2 + 2 * y * y) + 2 * p2 * x * y};
}

Eigen::Vector2d Lens::project(const Eigen::Vector2d& ray) const {
  const Eigen::Vector2d bent = distort(ray);
  return {fx * bent.x() + cx, fy * bent.y() + cy};
}

std::optional<Eigen::Vector2d> Lens::ray_of(const Eigen::Vector2d& pixel, double max) const {
  constexpr int kMaxSteps = 50;
  constexpr double kClose = 1e-12, kLongestStep = 0.1;
  const Eigen::Vector2d seen{(pixel.x() - cx) / fx, (pixel.y() - cy) / fy};
  Eigen::Vector2d ray = seen.norm() < max ? seen : Eigen::Vector2d{0.5 * max * seen.normalized()};
  for (int i = 0; i < kMaxSteps; ++i) {  // Newton
    const Eigen::Vector2d error = distort(ray) - seen;
    if (error.norm() < kClose && ray.norm() <= max) return ray;
    Eigen::Vector2d step = slope_at(distortion, ray).inverse() * error;
    if (step.norm() > kLongestStep) step *= kLongestStep / step.norm();
    ray -= step;
    if (!ray.allFinite()) return std::nullopt;
    if (ray.norm() > max) ray *= max / ray.norm();
  }
  return std::nullopt;
}

double Lens::max_radius() const {
  constexpr double kMax = 10, kStep = 0.005;
  for (double r = kStep; r < kMax; r += kStep) {
    const Radial radial = radial_at(distortion, r * r);
    if (!radial.finite || radial.factor + 2 * r * r * radial.slope <= 0) return r - kStep;
  }
  return kMax;
}

}  // namespace armature::stereo
