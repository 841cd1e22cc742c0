// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Geometry>

#include "sim_photo_scene_parameters.hpp"

namespace armature::sim::photo_scene {

/// How the patient holds his head. At tilt 0 the face looks along -x of the base; `tilt_up` turns
/// its normal towards +z, `tilt_side` towards +y; its upright stays as near to +z as it can.
struct HeadPose {
  Eigen::Vector3d mouth = Eigen::Vector3d::Zero();  // [m] in the base frame
  double tilt_up = 0, tilt_side = 0;                // [rad]
};

/// Unit normal of the face in the base frame, out of the face.
Eigen::Vector3d face_normal(const HeadPose& pose);

/// base_T_photo of a photo held where the face is: origin at the mouth, x to the photo's right as
/// seen by who looks at it, y down, z into the face.
Eigen::Isometry3d base_T_photo(const HeadPose& pose);

struct MovingHead {
  HeadPose pose;
  Eigen::Vector3d velocity;     // [m/s] of the mouth
  Eigen::Vector3d normal_rate;  // [1/s] of `face_normal`
  double tilt_side_rate;        // [rad/s]
};
/// Where the head is `t_s` after the start, while it moves once from rest to rest: a quintic
/// without jerk at its ends, 10 s^3 - 15 s^4 + 6 s^5, or with move_ramp_s at one speed between two
/// ramps.
MovingHead at(const Parameters& parameters, double t_s);

/// A direction of the base frame and how fast it changes [1/s].
struct TurningDirection {
  Eigen::Vector3d direction, rate;
};
/// A unit vector of the photo's frame, which the head carries with it, in the base frame.
TurningDirection carried(const MovingHead& head, const Eigen::Vector3d& in_photo);

}  // namespace armature::sim::photo_scene
