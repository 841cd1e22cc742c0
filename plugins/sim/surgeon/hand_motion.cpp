// SPDX-License-Identifier: Apache-2.0
#include "hand_motion.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <random>
#include <utility>

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

HandMotion::HandMotion(const Parameters& parameters, std::uint64_t seed,
                       std::optional<PosePath> path)
    : parameters_{parameters},
      path_{std::move(path)},
      leader_R_follower_{pose_of(parameters.console, parameters.console_rpy).linear().transpose()} {
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

Eigen::Isometry3d HandMotion::on_curve(double t, const Eigen::Isometry3d& start) const {
  const double u = phase(t);
  const Vector3d a = vector_of(parameters_.curve_m);
  const Vector3d curve{a.x() * (1 - std::cos(u)), a.y() * std::sin(u), a.z() * std::sin(2 * u)};
  const Eigen::AngleAxisd turn{parameters_.turn * std::sin(u), Vector3d{0.6, 0, 0.8}};
  Eigen::Isometry3d pose = start;
  pose.translation() += curve;
  pose.linear() = turn * start.linear();
  return pose;
}

/// The path lies along the axes of the follower's base, and the follower goes a part of the hand's
/// way.
Eigen::Isometry3d HandMotion::on_path(double t, const Eigen::Isometry3d& start) const {
  const Eigen::Isometry3d moved = path_->moved(t - parameters_.path_starts);
  const Eigen::Matrix3d turn = leader_R_follower_ * moved.linear() * leader_R_follower_.transpose();
  Eigen::Isometry3d pose = start;
  pose.translation() += leader_R_follower_ * moved.translation() / parameters_.path_scale;
  pose.linear() = turn * start.linear();
  return pose;
}

double HandMotion::clutch_opens() const {
  constexpr double kLags_s = 0.5;  // the follower, and what must come to rest
  if (!path_) return parameters_.clutch_opens;
  return std::max(parameters_.clutch_opens,
                  parameters_.path_starts + path_->duration_s() + kLags_s);
}

Eigen::Isometry3d HandMotion::intended(double t, const Eigen::Isometry3d& start) const {
  const double moved_on = eased((t - clutch_opens()) / parameters_.clutch_open_for);
  Eigen::Isometry3d pose = path_ ? on_path(t, start) : on_curve(t, start);
  pose.translation() += moved_on * vector_of(parameters_.shift);
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
  return t < clutch_opens() || t >= clutch_opens() + parameters_.clutch_open_for;
}

}  // namespace armature::sim::surgeon
