// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Geometry>
#include <filesystem>
#include <string_view>
#include <vector>

#include "armature/messages/geometry_msgs.hpp"
#include "armature/robot/trajectories/cubic_spline.hpp"
#include "armature/values/expected.hpp"

namespace armature::sim::surgeon {

/// Poses over time, as planned: positions on a cubic spline through them, from rest to rest;
/// rotations along the shortest turn from one to the next. Pure.
class PosePath {
 public:
  struct Row {
    double t = 0;  // [s]
    Eigen::Vector3d position = Eigen::Vector3d::Zero();
    Eigen::Quaterniond rotation = Eigen::Quaterniond::Identity();
  };
  /// Times ascend; at least two rows.
  explicit PosePath(std::vector<Row> rows);

  double duration_s() const { return rows_.back().t - rows_.front().t; }
  /// How the pose has moved since the first row, `t` seconds after it; before it nothing, after the
  /// last row all: a way along the axes of the file, and a turn about them.
  Eigen::Isometry3d moved(double t) const;

 private:
  std::vector<Row> rows_;
  KnottedPieces positions_;
};

/// Of a CSV with the columns t, x, y, z, qx, qy, qz, qw: seconds, metres, a quaternion; a first
/// line that names them may be there, empty lines and those that begin with # are passed over.
/// Refuses, as `name`:line, what is no number or not finite, times that do not ascend, and a
/// quaternion whose length is not 1 within 1 %.
Expected<PosePath> read_pose_path(std::string_view text, std::string_view name);
/// The same of a file; or why it cannot be read.
Expected<PosePath> load_pose_path(const std::filesystem::path& file);

/// Through poses that have no times, at a mean of `speed` [m/s], and where it turns more than it
/// goes at most half a radian per second; a pose that is the one before it is passed over. Refuses,
/// as `name`, what is not finite, a quaternion whose length is not 1 within 1 %, and fewer than two
/// poses.
Expected<PosePath> pose_path_through(const msg::PoseArray& poses, double speed,
                                     std::string_view name);

}  // namespace armature::sim::surgeon
