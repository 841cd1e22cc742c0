// SPDX-License-Identifier: Apache-2.0
#include "hand_motion.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <random>

#include "armature/kinds/geometry_params.hpp"
#include "armature/robot/trajectories/quintic.hpp"

namespace armature::sim::surgeon {
namespace {

using Eigen::Vector3d;

constexpr double kTurn = 2 * std::numbers::pi;
constexpr double kLowest_hz = 8, kHighest_hz = 12;
constexpr int kTonesPerAxis = 3;

/// From 0 to 1 while s does, at rest at both ends, and its integral.
double eased(double s) {
  return Quintic::between({0, 0, 0}, {1, 0, 0}, 1).position(std::clamp(s, 0.0, 1.0));
}
double eased_integral(double s) {
  if (s >= 1) return 0.5 + (s - 1);
  return s <= 0 ? 0 : s * s * s * s * (2.5 + s * (-3 + s));
}

}  // namespace

HandMotion::HandMotion(const Parameters& parameters, std::uint64_t seed) : parameters_{parameters} {
  std::mt19937_64 random{seed};
  std::uniform_real_distribution<double> frequency{kLowest_hz, kHighest_hz}, phase{0, kTurn};
  // The mean square of a sine is half of its amplitude's square.
  const double amplitude = parameters.tremor * std::sqrt(2.0 / (3 * kTonesPerAxis));
  for (int axis = 0; axis < 3; ++axis) {
    for (int i = 0; i < kTonesPerAxis; ++i) {
      const double hz = frequency(random);
      tremor_.push_back({amplitude * Vector3d::Unit(axis), kTurn * hz, phase(random)});
    }
  }
}

double HandMotion::phase(double t) const {
  const double ease = parameters_.ease;
  return kTurn * parameters_.curve_hz * (ease > 0 ? ease * eased_integral(t / ease) : t);
}

Eigen::Isometry3d HandMotion::intended(double t, const Eigen::Isometry3d& start) const {
  const double u = phase(t);
  const Vector3d a = vector_of(parameters_.curve_m);
  const Vector3d curve{a.x() * (1 - std::cos(u)), a.y() * std::sin(u), a.z() * std::sin(2 * u)};
  const double moved_on = eased((t - parameters_.clutch_opens) / parameters_.clutch_open_for);
  const Eigen::AngleAxisd turn{parameters_.turn * std::sin(u), Vector3d{0.6, 0, 0.8}};
  Eigen::Isometry3d pose = start;
  pose.translation() += curve + moved_on * vector_of(parameters_.shift);
  pose.linear() = turn * start.linear();
  return pose;
}

Eigen::Isometry3d HandMotion::actual(double t, const Eigen::Isometry3d& start) const {
  Eigen::Isometry3d pose = intended(t, start);
  const double grip = parameters_.ease > 0 ? eased(t / parameters_.ease) : 1;
  for (const Tone& tone : tremor_) {
    pose.translation() += grip * std::sin(tone.omega * t + tone.phase) * tone.amplitude;
  }
  return pose;
}

bool HandMotion::clutch_closed(double t) const {
  if (t < parameters_.clutch_closes) return false;
  return t < parameters_.clutch_opens ||
         t >= parameters_.clutch_opens + parameters_.clutch_open_for;
}

}  // namespace armature::sim::surgeon
