// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <span>
#include <vector>

#include "armature/robot/model/joint_vector.hpp"
#include "armature/robot/trajectories/quintic.hpp"

namespace armature ARMATURE_EXPORT {

/// The C4 quintic spline through `points` at `knots` (ascending, at least two) with given
/// velocities and accelerations at both ends, per joint; pieces piece-major as in Trajectory.
/// O(points) (block-tridiagonal elimination on the knots' velocities and accelerations).
std::vector<Quintic> quintic_spline(std::span<const double> knots,
                                    std::span<const JointVector> points, const JointState& first,
                                    const JointState& last);

}  // namespace armature
