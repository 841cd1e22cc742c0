// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <map>
#include <utility>
#include <vector>

#include "saddle_points.hpp"

namespace armature::chessboard {

/// Corners by their place in a grid, which begins somewhere.
using CornerGrid = std::map<std::pair<int, int>, std::size_t>;  // (column, row): which point

/// The grid that is reached from point `seed`, step by step along its edges: each next corner lies
/// where the last step leads, to a third of the step.
CornerGrid grown_grid(const std::vector<SaddlePoint>& points, std::size_t seed);

}  // namespace armature::chessboard
