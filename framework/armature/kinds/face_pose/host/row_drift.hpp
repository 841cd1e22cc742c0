// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <optional>
#include <string>

#include "armature/kinds/face_pose/face_pose.hpp"
#include "host_face_pose_parameters.hpp"

namespace armature::host::face_pose {

/// Sees a calibration that drifts before any pair is refused for it: the slow mean of what the rows
/// of the pictures differ by, over about the last fifty pairs that an estimator has measured it in.
/// A pair errs by a few thousandths of a pixel, a camera that was bumped by the same in all.
class RowDrift {
 public:
  explicit RowDrift(const Parameters& parameters) : parameters_{parameters} {}

  void add(const RowDifference& rows);
  /// What to tell the operator when the mean exceeds its limits, with its size; nothing otherwise,
  /// nor before twenty pairs. `width`, `height`: of the pictures [px].
  std::optional<std::string> warning(int width, int height) const;

 private:
  Parameters parameters_;
  Eigen::Vector3d mean_ = Eigen::Vector3d::Zero();  // [px] at the face, [px/px] by column and row
  int pairs_ = 0;
};

}  // namespace armature::host::face_pose
