// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Geometry>

namespace armature {

// Rotation vectors P = angle * axis [rad] and unit quaternions (Zhong et al. 2023, equations (2)
// and (3)). All functions are real-time safe.

/// P = 2 ln q of the shorter way round, |P| <= pi. At half a turn both signs are right; that of
/// q's vector part is taken.
Eigen::Vector3d rotation_vector_of(const Eigen::Quaterniond& unit);

/// P = 2 ln q as q stands, 0 <= |P| < 2 pi: q and -q have different ones. Continuous in q, except
/// at -1, which has no axis.
Eigen::Vector3d double_logarithm(const Eigen::Quaterniond& unit);

/// q = [cos(|P|/2), sin(|P|/2) P/|P|].
Eigen::Quaterniond rotation_of(const Eigen::Vector3d& P);

/// What turns by a rotation vector P and by its changes: exp(P) and its Jacobians at one P.
class RotationAt {
 public:
  explicit RotationAt(const Eigen::Vector3d& P);
  /// The same where exp(P) is known, without a sine: P = double_logarithm(rotation).
  RotationAt(const Eigen::Vector3d& P, const Eigen::Quaterniond& rotation);

  /// rotation_of(P).
  Eigen::Quaterniond rotation() const;
  /// J_l(P) dP, the angular velocity in the frame in which P is told when P changes with dP:
  /// J_l = I + (1 - cos t)/t^2 [P] + (t - sin t)/t^3 [P]^2 with t = |P|. It is not dP.
  Eigen::Vector3d velocity(const Eigen::Vector3d& dP) const;
  /// The angular acceleration J_l(P) ddP + (d/du J_l(P)) dP.
  Eigen::Vector3d acceleration(const Eigen::Vector3d& dP, const Eigen::Vector3d& ddP) const;
  /// The dP with velocity(dP) == `velocity`; t must be below 2 pi.
  Eigen::Vector3d rate_of(const Eigen::Vector3d& velocity) const;

 private:
  RotationAt(const Eigen::Vector3d& P, double t);
  RotationAt(const Eigen::Vector3d& P, double t, double half_cos, double half_sine);

  Eigen::Vector3d P_;
  double t_, half_cos_, half_sinc_;  // sin(t/2)/t
  double a_, b_;                     // of [P] and [P]^2 in J_l
};

}  // namespace armature
