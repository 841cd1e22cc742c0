// SPDX-License-Identifier: Apache-2.0
// What can be measured on an orientation curve, by looking at its samples only.
#pragma once

#include <vector>

#include "armature/robot/orientations/orientation_curve.hpp"

namespace armature ARMATURE_EXPORT {

/// Between two rotations [rad].
double turn_between(const Eigen::Quaterniond& a, const Eigen::Quaterniond& b);

/// Parameters from end to end, every piece in `parts`: each piece is looked at as closely as any
/// other, however many there are.
std::vector<double> parameters_along(const OrientationCurve& curve, int parts);

/// [rad] the sum of the turns from sample to sample.
double total_rotation(const OrientationCurve& curve, int parts = 2000);

/// Largest norms of angular velocity [rad] and acceleration [rad] for a parameter without unit.
struct OrientationPeaks {
  double velocity = 0, acceleration = 0;
};
OrientationPeaks peaks_of(const OrientationCurve& curve, int parts = 2000);

/// By how much rotation, angular velocity and acceleration differ `eps` before and behind `u`.
struct OrientationJump {
  double rotation = 0, velocity = 0, acceleration = 0;
};
OrientationJump jump_at(const OrientationCurve& curve, double u, double eps);
/// The largest of each where pieces meet.
OrientationJump largest_jump(const OrientationCurve& curve, double eps);
/// The same, looked at from `part` of the shorter of the two pieces that meet.
OrientationJump largest_jump_beside(const OrientationCurve& curve, double part);

}  // namespace armature
