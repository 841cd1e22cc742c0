// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <vector>

#include "armature/robot/model/joint_vector.hpp"
#include "armature/robot/trajectories/quintic.hpp"

namespace armature ARMATURE_EXPORT {

/// Pieces between knots, piece-major as in Trajectory.
struct KnottedPieces {
  std::vector<double> knots;    // [s], ascending
  std::vector<Quintic> pieces;  // cubics: c4 = c5 = 0
};

/// The cubic spline through `points` at `knots` (ascending, at least two) with given velocities and
/// accelerations at both ends, per joint, continuous in the acceleration. A cubic spline has two
/// degrees of freedom too few for that, so two knots more, whose points are free, lie in the middle
/// of the first and of the last interval (at thirds, when there is one only): C.-S. Lin, P.-R.
/// Chang, J. Y. S. Luh, "Formulation and optimization of cubic polynomial joint trajectories for
/// industrial robots", IEEE Transactions on Automatic Control 28(12), 1983. O(points), one
/// tridiagonal elimination for all joints.
KnottedPieces cubic_spline(std::span<const double> knots, std::span<const JointVector> points,
                           const JointState& first, const JointState& last);

}  // namespace armature
