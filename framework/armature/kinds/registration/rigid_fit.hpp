// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Geometry>
#include <span>

namespace armature ARMATURE_EXPORT {

/// The motion that takes `from` to `to`, point by point, with the least sum of squares (S. Umeyama,
/// IEEE Transactions on Pattern Analysis and Machine Intelligence 13(4), 1991): a rotation also
/// where a reflection would fit better. At least one point, as many of both. Allocates.
Eigen::Isometry3d rigid_fit(std::span<const Eigen::Vector3d> from,
                            std::span<const Eigen::Vector3d> to);

/// By which `to_T_from` misses `to`, rms [m].
double rms_of(const Eigen::Isometry3d& to_T_from, std::span<const Eigen::Vector3d> from,
              std::span<const Eigen::Vector3d> to);

/// The same of the best motion after a reflection.
double mirrored_rms(std::span<const Eigen::Vector3d> from, std::span<const Eigen::Vector3d> to);

}  // namespace armature
