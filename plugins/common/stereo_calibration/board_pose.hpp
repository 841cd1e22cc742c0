// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Geometry>
#include <optional>
#include <vector>

namespace armature::stereo {

/// Maps the board's points to pixels, up to distortion: the least squares solution of the linear
/// equations (Hartley and Zisserman, Multiple View Geometry, algorithm 4.2).
Eigen::Matrix3d homography(const std::vector<Eigen::Vector2d>& board,
                           const std::vector<Eigen::Vector2d>& pixels);

/// The focal length of a camera with square pixels and its principal point at `centre`, from
/// homographies of boards that are turned; nothing where they are too parallel to tell.
std::optional<double> focal_length(const std::vector<Eigen::Matrix3d>& homographies,
                                   const Eigen::Vector2d& centre);

/// camera_T_board of a homography.
Eigen::Isometry3d pose_of_board(const Eigen::Matrix3d& homography, double focal_px,
                                const Eigen::Vector2d& centre);

}  // namespace armature::stereo
