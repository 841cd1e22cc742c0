// SPDX-License-Identifier: Apache-2.0
#include "tremor_filter.hpp"

#include <cmath>
#include <complex>
#include <cstddef>
#include <numbers>

#include "hand_period.hpp"

namespace armature::task::teleoperation {
namespace {

using std::numbers::pi;

constexpr int kOrder = 4;

/// A pole pair, a zero pair, both of s, by the bilinear transform z = (1 + s T/2) / (1 - s T/2).
struct Pair {
  std::complex<double> pole;  // [rad/s]
  double zero;                // on the imaginary axis
};

/// Pair k = 1, 2 of the prototype with its stop band from `omega` on: with e = 1 / sqrt(10^(A/10) -
/// 1), m = asinh(1/e) / n and t = pi (2k - 1) / (2n) the zeros are +-i omega / cos t and the poles
/// omega / (-sinh m sin t +- i cosh m cos t).
Pair pair_of(int k, double omega, double attenuation_db) {
  const double e = 1 / std::sqrt(std::pow(10, attenuation_db / 10) - 1);
  const double m = std::asinh(1 / e) / kOrder;
  const double t = pi * (2 * k - 1) / (2 * kOrder);
  return {
      .pole = omega / std::complex<double>{-std::sinh(m) * std::sin(t), std::cosh(m) * std::cos(t)},
      .zero = omega / std::cos(t)};
}

}  // namespace

TremorFilter::TremorFilter(const Parameters& parameters) {
  const double half = kHandPeriod_s / 2;
  // So that the stop band begins at stop_hz after the transform, which bends frequencies.
  const double omega = std::tan(2 * pi * parameters.stop * half) / half;
  for (int k = 1; k <= 2; ++k) {
    const Pair pair = pair_of(k, omega, parameters.attenuation);
    const std::complex<double> pole = (1.0 + pair.pole * half) / (1.0 - pair.pole * half);
    const double cosine = std::cos(2 * std::atan(pair.zero * half));
    Section& section = sections_[static_cast<std::size_t>(k - 1)];
    section.a = {1, -2 * pole.real(), std::norm(pole)};
    const double gain = (section.a[0] + section.a[1] + section.a[2]) / (2 - 2 * cosine);
    section.b = {gain, -2 * gain * cosine, gain};
  }
}

void TremorFilter::Section::start(const Channels& x) {
  s2 = (b[2] - a[2]) * x;
  s1 = (b[1] - a[1]) * x + s2;
}

TremorFilter::Channels TremorFilter::Section::step(const Channels& x) {
  const Channels y = b[0] * x + s1;
  s1 = b[1] * x - a[1] * y + s2;
  s2 = b[2] * x - a[2] * y;
  return y;
}

TremorFilter::Channels TremorFilter::channels_of(const Eigen::Isometry3d& pose) const {
  Channels x;
  x << pose.translation(), Eigen::Quaterniond{pose.linear()}.coeffs();
  if (x.tail<4>().dot(last_.tail<4>()) < 0) x.tail<4>() = -x.tail<4>();
  return x;
}

void TremorFilter::start(const Eigen::Isometry3d& pose) {
  last_ = channels_of(pose);
  for (Section& section : sections_) section.start(last_);
}

Eigen::Isometry3d TremorFilter::step(const Eigen::Isometry3d& pose, int periods) {
  const Channels before = last_;
  last_ = channels_of(pose);
  Channels y;
  for (int k = 1; k <= periods; ++k) {
    y = before + (last_ - before) * k / periods;
    for (Section& section : sections_) y = section.step(y);
  }
  const Eigen::Vector4d rotation = y.tail<4>().normalized();
  Eigen::Isometry3d filtered = Eigen::Isometry3d::Identity();
  filtered.translation() = y.head<3>();
  filtered.linear() = Eigen::Quaterniond{rotation}.toRotationMatrix();
  return filtered;
}

double TremorFilter::lag_s() const {
  double samples = 0;
  for (const Section& section : sections_) {
    const auto centre = [](const std::array<double, 3>& c) {
      return (c[1] + 2 * c[2]) / (c[0] + c[1] + c[2]);
    };
    samples += centre(section.b) - centre(section.a);
  }
  return samples * kHandPeriod_s;
}

double TremorFilter::gain(double hz) const {
  const std::complex<double> back = std::polar(1.0, -2 * pi * hz * kHandPeriod_s);  // z^-1
  double gain = 1;
  for (const Section& section : sections_) {
    const auto value = [&](const std::array<double, 3>& c) {
      return std::abs(c[0] + back * (c[1] + back * c[2]));
    };
    gain *= value(section.b) / value(section.a);
  }
  return gain;
}

}  // namespace armature::task::teleoperation
