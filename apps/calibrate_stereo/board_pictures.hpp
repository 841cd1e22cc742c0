// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <vector>

#include "chessboard.hpp"
#include "stereo_fit.hpp"

namespace armature {

/// What was found in the pictures of two folders.
struct BoardPictures {
  int width = 0, height = 0;             // [px] of all pictures
  std::size_t pairs = 0;                 // that were looked at
  std::vector<stereo::BoardView> views;  // those with the board in both pictures
};

/// Looks for a board in all pairs, and tells each that shows none, or a picture that another pair
/// has, on standard error. Throws SetupError for folders that are none, and std::runtime_error for
/// pictures of different sizes.
BoardPictures read_board_pictures(const std::filesystem::path& left,
                                  const std::filesystem::path& right,
                                  const chessboard::BoardShape& shape);

}  // namespace armature
