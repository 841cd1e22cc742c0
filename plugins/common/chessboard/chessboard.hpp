// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <span>
#include <vector>

#include "armature/values/expected.hpp"

namespace armature::chessboard {

/// A board with black and white squares: corners where four squares meet.
struct BoardShape {
  int columns = 9, rows = 6;  // of inner corners
  int corners() const { return columns * rows; }
};

/// Finds all corners of a board in a mono8 picture of `width` x `height` pixels, row by row, to a
/// few hundredths of a pixel; pixel centres are at integers. Rows run so that the board is not
/// mirrored. Where columns and rows are not both even or both odd, the first corner is the one
/// whose first square between corners is black, whichever way the board is held; else it is the
/// one of two, or of four where the sides are equal, from which the last corner lies farthest in
/// the direction `towards`: at the picture's upper left, or as in another view of the board,
/// whose last minus first corner is given.
///
/// Corners are saddle points of the brightness, around which it is dark, bright, dark and bright;
/// from one of them a grid is grown step by step. Refuses a picture in which not the whole board is
/// seen, with the largest grid that is. Not real-time safe.
Expected<std::vector<Eigen::Vector2d>> find_board(std::span<const std::uint8_t> pixels, int width,
                                                  int height, const BoardShape& shape,
                                                  const Eigen::Vector2d& towards = {1, 1});

}  // namespace armature::chessboard
