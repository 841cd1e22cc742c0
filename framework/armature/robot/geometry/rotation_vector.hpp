// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Geometry>

namespace armature ARMATURE_EXPORT {

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

}  // namespace armature
