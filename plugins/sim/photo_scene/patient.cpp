// SPDX-License-Identifier: Apache-2.0
#include "patient.hpp"

#include <algorithm>
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

MovingHead at(const Parameters& parameters, double t_s) {
  const double duration = parameters.move_duration;
  const double s = duration > 0 ? std::clamp((t_s - parameters.move_at) / duration, 0.0, 1.0) : 0.0;
  const double share = s * s * s * (10 + s * (-15 + 6 * s));
  const double rate = duration > 0 ? 30 * s * s * (1 - s) * (1 - s) / duration : 0.0;
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
