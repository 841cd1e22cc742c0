// SPDX-License-Identifier: Apache-2.0
#include "band_power.hpp"

#include <cmath>
#include <numbers>

namespace armature {

double band_power(std::span<const TrackPoint> track, double from_hz, double to_hz) {
  if (track.size() < 3) return 0;
  constexpr double kTurn = 2 * std::numbers::pi;
  const double begin = track.front().t, duration = track.back().t - begin;
  Eigen::Vector3d mean = Eigen::Vector3d::Zero();
  for (const TrackPoint& point : track) mean += point.position;
  mean /= static_cast<double>(track.size());
  double sum = 0;
  for (double k = std::ceil(from_hz * duration); k <= to_hz * duration; ++k) {
    Eigen::Vector3d real = Eigen::Vector3d::Zero(), imaginary = Eigen::Vector3d::Zero();
    for (const TrackPoint& point : track) {
      const double turns = (point.t - begin) / duration;
      const Eigen::Vector3d x = (0.5 - 0.5 * std::cos(kTurn * turns)) * (point.position - mean);
      real += std::cos(kTurn * k * turns) * x;
      imaginary += std::sin(kTurn * k * turns) * x;
    }
    sum += real.squaredNorm() + imaginary.squaredNorm();
  }
  // A sine of amplitude A adds A^2 n^2 / 16 at its own multiple and a quarter of that at each of
  // its neighbours.
  const double n = static_cast<double>(track.size());
  return 16.0 / 3.0 * sum / (n * n);
}

}  // namespace armature
