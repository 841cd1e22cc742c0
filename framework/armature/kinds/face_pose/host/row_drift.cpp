// SPDX-License-Identifier: Apache-2.0
#include "row_drift.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace armature::host::face_pose {

void RowDrift::add(const RowDifference& rows) {
  constexpr int kMemory = 50;  // pairs
  const Eigen::Vector3d now{rows.at_face_px, rows.by_column, rows.by_row};
  if (!now.allFinite()) return;
  pairs_ = std::min(pairs_ + 1, kMemory);
  mean_ += (now - mean_) / pairs_;
}

std::optional<std::string> RowDrift::warning(int width, int height) const {
  constexpr int kFewest = 20;  // pairs
  if (pairs_ < kFewest) return std::nullopt;
  const double at_face = std::abs(mean_[0]);
  const double across = std::hypot(mean_[1] * width, mean_[2] * height);
  if (at_face <= parameters_.max_mean_row_error && across <= parameters_.max_mean_row_spread) {
    return std::nullopt;
  }
  return fmt::format(
      "the cameras are no longer well calibrated: on average the rows of their pictures differ by "
      "{:.2f} px at the face (at most {:g}), and by {:.1f} px more on one side of the picture than "
      "on the other (at most {:g}); calibrate them again with 'armature calibrate stereo', before "
      "faces are refused",
      at_face, parameters_.max_mean_row_error, across, parameters_.max_mean_row_spread);
}

}  // namespace armature::host::face_pose
