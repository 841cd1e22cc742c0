// SPDX-License-Identifier: Apache-2.0
#include "band_power.hpp"

#include <algorithm>
#include <cmath>
#include <complex>
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

/// In one window over the whole track.
double power_of(std::span<const TrackPoint> track, double from_hz, double to_hz) {
  if (track.size() < 3) return 0;
  constexpr double kTurn = 2 * std::numbers::pi;
  const double begin = track.front().t, duration = track.back().t - begin;
  const std::vector<double> shares = shares_of(track);
  Eigen::Vector3d mean = Eigen::Vector3d::Zero();
  for (std::size_t i = 0; i < track.size(); ++i) mean += shares[i] * track[i].position;
  struct Harmonic {
    Eigen::Vector3d x;
    std::complex<double> turn, at;  // of the first multiple, and of the present one
  };
  std::vector<Harmonic> harmonics;
  const double first = std::ceil(from_hz * duration);
  for (std::size_t i = 0; i < track.size(); ++i) {
    const double angle = kTurn * (track[i].t - begin) / duration;
    const double weight = shares[i] * (0.5 - 0.5 * std::cos(angle));
    harmonics.push_back({weight * (track[i].position - mean), std::polar(1.0, angle),
                         std::polar(1.0, first * angle)});
  }
  double sum = 0;
  for (double k = first; k <= to_hz * duration; ++k) {
    Eigen::Vector3d real = Eigen::Vector3d::Zero(), imaginary = Eigen::Vector3d::Zero();
    for (Harmonic& harmonic : harmonics) {
      real += harmonic.at.real() * harmonic.x;
      imaginary += harmonic.at.imag() * harmonic.x;
      harmonic.at *= harmonic.turn;
    }
    sum += real.squaredNorm() + imaginary.squaredNorm();
  }
  // A sine of amplitude A adds A^2 / 16 at its own multiple and a quarter of that at each of its
  // neighbours.
  return 16.0 / 3.0 * sum;
}

}  // namespace

double band_power(std::span<const TrackPoint> track, double from_hz, double to_hz) {
  if (track.empty()) return 0;
  constexpr double kWindow_s = 5;
  const double begin = track.front().t, duration = track.back().t - begin;
  const double lasts = std::min(duration, kWindow_s);
  const int count = lasts < duration ? static_cast<int>(std::ceil(2 * duration / lasts)) - 1 : 1;
  const double apart = count > 1 ? (duration - lasts) / (count - 1) : 0;
  double sum = 0;
  for (int i = 0; i < count; ++i) {
    const double from = begin + i * apart;
    const auto first = std::ranges::lower_bound(track, from, {}, &TrackPoint::t);
    const auto last = std::ranges::upper_bound(track, from + lasts, {}, &TrackPoint::t);
    sum += power_of({first, last}, from_hz, to_hz);
  }
  return sum / count;
}

}  // namespace armature::report::teleoperation
