// SPDX-License-Identifier: Apache-2.0
#include "band_power.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <numbers>
#include <vector>

namespace armature::report::teleoperation {
namespace {

/// The time that a point stands for, as a part of the whole: points may come unevenly.
std::vector<double> shares_of(std::span<const TrackPoint> track) {
  const double duration = track.back().t - track.front().t;
  std::vector<double> shares;
  for (std::size_t i = 0; i < track.size(); ++i) {
    const double from = track[i == 0 ? 0 : i - 1].t,
                 to = track[std::min(i + 1, track.size() - 1)].t;
    shares.push_back(0.5 * (to - from) / duration);
  }
  return shares;
}

}  // namespace

double band_power(std::span<const TrackPoint> track, double from_hz, double to_hz) {
  if (track.size() < 3) return 0;
  constexpr double kTurn = 2 * std::numbers::pi;
  const double begin = track.front().t, duration = track.back().t - begin;
  const std::vector<double> shares = shares_of(track);
  Eigen::Vector3d mean = Eigen::Vector3d::Zero();
  for (std::size_t i = 0; i < track.size(); ++i) mean += shares[i] * track[i].position;
  double sum = 0;
  for (double k = std::ceil(from_hz * duration); k <= to_hz * duration; ++k) {
    Eigen::Vector3d real = Eigen::Vector3d::Zero(), imaginary = Eigen::Vector3d::Zero();
    for (std::size_t i = 0; i < track.size(); ++i) {
      const double angle = kTurn * (track[i].t - begin) / duration;
      const Eigen::Vector3d x =
          shares[i] * (0.5 - 0.5 * std::cos(angle)) * (track[i].position - mean);
      real += std::cos(k * angle) * x;
      imaginary += std::sin(k * angle) * x;
    }
    sum += real.squaredNorm() + imaginary.squaredNorm();
  }
  // A sine of amplitude A adds A^2 / 16 at its own multiple and a quarter of that at each of its
  // neighbours.
  return 16.0 / 3.0 * sum;
}

}  // namespace armature::report::teleoperation
