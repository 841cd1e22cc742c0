// SPDX-License-Identifier: Apache-2.0
#include "scatter.hpp"

#include <Eigen/Cholesky>
#include <algorithm>

#include "measurement_noise.hpp"

namespace armature::target::constant_velocity {
namespace {

constexpr int kFewest = 5;  // ratios whose median tells something

// Medians of the chi-square distributions with 3 and 2 degrees of freedom.
constexpr double kMedianOfPoint = 2.366, kMedianOfDirection = 1.386;

/// The squared distance of `now` from the line through the two before, in units of what
/// `covariance`, the same for all three, explains. `forward`: the time from `last` to `now` over
/// the one before it.
double square(const Eigen::Vector3d& now, const std::array<double, 3>& last,
              const std::array<double, 3>& before_last, double forward,
              const Eigen::Matrix3d& covariance) {
  const Eigen::Vector3d one{last.data()}, other{before_last.data()};
  const Eigen::Vector3d off = now - one - forward * (one - other);
  const double parts = 1 + (1 + forward) * (1 + forward) + forward * forward;
  const Eigen::Matrix3d explained = parts * covariance;
  return off.dot(explained.llt().solve(off));
}

}  // namespace

double Scatter::Ratios::inflation(int count) const {
  if (count < kFewest) return 1;
  std::array<float, kWindow> sorted = newest;
  const auto end = sorted.begin() + std::min(count, kWindow);
  const auto middle = sorted.begin() + (end - sorted.begin()) / 2;
  std::nth_element(sorted.begin(), middle, end);
  return std::max(*middle, 1.0F);
}

void Scatter::add(const TargetMeasurement& measurement) {
  const Eigen::Vector3d &p = measurement.position, &n = measurement.normal;
  if (sights >= 2) {
    const double forward =
        to_seconds(measurement.stamp - last.stamp) / to_seconds(last.stamp - before_last.stamp);
    const auto noise = measurement_noise(measurement);
    const auto at = static_cast<std::size_t>(ratios % kWindow);
    const auto in_medians = [&](double squared, double median) {
      return static_cast<float>(squared / median);
    };
    of_position.newest[at] = in_medians(
        square(p, last.position, before_last.position, forward, noise.topLeftCorner<3, 3>()),
        kMedianOfPoint);
    of_normal.newest[at] = in_medians(
        square(n, last.normal, before_last.normal, forward, noise.bottomRightCorner<3, 3>()),
        kMedianOfDirection);
    ++ratios;
  }
  before_last = last;
  last = {measurement.stamp, {p.x(), p.y(), p.z()}, {n.x(), n.y(), n.z()}};
  ++sights;
}

TargetMeasurement Scatter::explained(TargetMeasurement measurement) const {
  measurement.position_covariance *= of_position.inflation(ratios);
  measurement.normal_covariance *= of_normal.inflation(ratios);
  return measurement;
}

}  // namespace armature::target::constant_velocity
