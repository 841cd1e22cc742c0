// SPDX-License-Identifier: Apache-2.0
#include "patient.hpp"

#include <cmath>

#include "armature/kinds/geometry_params.hpp"

namespace armature::sim::photo_scene {

Eigen::Vector3d face_normal(const HeadPose& pose) {
  const double cu = std::cos(pose.tilt_up), su = std::sin(pose.tilt_up);
  const double cs = std::cos(pose.tilt_side), ss = std::sin(pose.tilt_side);
  return {-cu * cs, cu * ss, su};
}

Eigen::Isometry3d base_T_photo(const HeadPose& pose) {
  const Eigen::Vector3d forward = -face_normal(pose);
  // Horizontal, so that the head is upright; from the angle and not from forward x z, which
  // vanishes for a patient who looks straight up.
  const Eigen::Vector3d right{-std::sin(pose.tilt_side), -std::cos(pose.tilt_side), 0};
  Eigen::Isometry3d result = Eigen::Isometry3d::Identity();
  result.linear().col(0) = right;
  result.linear().col(1) = forward.cross(right);
  result.linear().col(2) = forward;
  result.translation() = pose.mouth;
  return result;
}

namespace {

/// How much of the move is done, and how fast that grows [1/s].
struct Progress {
  double share, rate;
};

/// From rest to rest in one quintic without jerk at its ends.
Progress smooth(double t_s, double duration_s) {
  const double s = t_s / duration_s;
  return {s * s * s * (10 + s * (-15 + 6 * s)), 30 * s * s * (1 - s) * (1 - s) / duration_s};
}

/// The speed rises as 3 u^2 - 2 u^3 over the ramp, stays, and falls in the same way.
Progress steady(double t_s, double duration_s, double ramp_s) {
  const double speed = 1 / (duration_s - ramp_s);
  if (t_s > duration_s / 2) {
    const Progress mirrored = steady(duration_s - t_s, duration_s, ramp_s);
    return {1 - mirrored.share, mirrored.rate};
  }
  if (t_s >= ramp_s) return {speed * (t_s - ramp_s / 2), speed};
  const double u = t_s / ramp_s;
  return {speed * ramp_s * u * u * u * (1 - u / 2), speed * u * u * (3 - 2 * u)};
}

Progress progress(const Parameters& parameters, double t_s) {
  const double duration_s = parameters.move_duration;
  if (duration_s <= 0 || t_s <= 0) return {0, 0};
  if (t_s >= duration_s) return {1, 0};
  const double ramp_s = parameters.move_ramp;
  return ramp_s > 0 ? steady(t_s, duration_s, ramp_s) : smooth(t_s, duration_s);
}

}  // namespace

MovingHead at(const Parameters& parameters, double t_s) {
  const auto [share, rate] = progress(parameters, t_s - parameters.move_at);
  const double turn_up = parameters.move_tilt_up, turn_side = parameters.move_tilt_side;
  const Eigen::Vector3d shift = vector_of(parameters.move);

  MovingHead head;
  head.pose = {.mouth = vector_of(parameters.mouth) + share * shift,
               .tilt_up = parameters.tilt_up + share * turn_up,
               .tilt_side = parameters.tilt_side + share * turn_side};
  head.velocity = rate * shift;
  const double cu = std::cos(head.pose.tilt_up), su = std::sin(head.pose.tilt_up);
  const double cs = std::cos(head.pose.tilt_side), ss = std::sin(head.pose.tilt_side);
  head.normal_rate = rate * (turn_up * Eigen::Vector3d{su * cs, -su * ss, cu} +
                             turn_side * Eigen::Vector3d{cu * ss, cu * cs, 0});
  head.tilt_side_rate = rate * turn_side;
  return head;
}

TurningDirection carried(const MovingHead& head, const Eigen::Vector3d& in_photo) {
  const Eigen::Matrix3d axes = base_T_photo(head.pose).linear();
  const double side = head.pose.tilt_side;
  Eigen::Matrix3d rates;
  rates.col(0) = head.tilt_side_rate * Eigen::Vector3d{-std::cos(side), std::sin(side), 0};
  rates.col(2) = -head.normal_rate;
  rates.col(1) = rates.col(2).cross(axes.col(0)) + axes.col(2).cross(rates.col(0));
  return {axes * in_photo, rates * in_photo};
}

}  // namespace armature::sim::photo_scene
