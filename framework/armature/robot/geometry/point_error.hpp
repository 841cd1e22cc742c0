// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>

namespace armature ARMATURE_EXPORT {

/// How far a point is likely to be from where it is said to be.
struct PointError {
  Eigen::Matrix3d covariance = Eigen::Matrix3d::Zero();  // [m^2]
  double rms_m = 0;
  double bound95_m = 0;  // 95 of 100 are nearer
};

/// Of a normal distribution about zero.
PointError point_error(const Eigen::Matrix3d& covariance);

/// Of a normal distribution about zero: the radius of the sphere that holds 95 %. By Wilson and
/// Hilferty's cube root of a chi-squared of the same mean and variance: at most 1.3 % too small
/// (an error along one line), 0.3 % for the same error in all directions.
double radius_of_95_percent(const Eigen::Matrix3d& covariance);

/// The radius that 999 of 1000 such errors stay below, of an error of which rms and the 95 % radius
/// are known: the chi-squared that both belong to, further out, by the same approximation: within
/// 2.5 % (an error along one line), 0.9 % for the same in all directions. 0 where none is expected.
double radius_of_999_in_1000(double rms_m, double radius95_m);

}  // namespace armature
