// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Geometry>

namespace armature {

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

/// One movement of the head, rest to rest.
struct HeadMotion {
  HeadPose from;
  Eigen::Vector3d shift = Eigen::Vector3d::Zero();  // [m]
  double turn_up = 0, turn_side = 0;                // [rad]
  double begin_s = 0, duration_s = 0;               // no movement when duration_s is 0
};

struct MovingHead {
  HeadPose pose;
  Eigen::Vector3d velocity;     // [m/s] of the mouth
  Eigen::Vector3d normal_rate;  // [1/s]
};
/// Where the head is `t_s` after the start: a quintic without jerk at its ends, 10 s^3 - 15 s^4 + 6
/// s^5.
MovingHead at(const HeadMotion& motion, double t_s);

}  // namespace armature
