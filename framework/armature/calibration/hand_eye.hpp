// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Geometry>
#include <cstddef>
#include <optional>
#include <span>

#include "armature/robot/geometry/point_error.hpp"
#include "armature/values/expected.hpp"

namespace armature ARMATURE_EXPORT {

/// At one moment: where the flange was, and where the tracker saw the body that is fixed to it.
struct HandEyePose {
  Eigen::Isometry3d base_T_flange = Eigen::Isometry3d::Identity();
  Eigen::Isometry3d tracker_T_body = Eigen::Isometry3d::Identity();
};

/// Of a measured pose: standard deviations along (about) each axis.
struct PoseNoise {
  double position_m = 0;
  double rotation_rad = 0;
};

struct HandEyeOptions {
  /// Of tracker_T_body against what the flange says; none: as the residuals show.
  std::optional<PoseNoise> noise;
  /// By which the orientations must turn about a second axis, rms.
  double min_spread_rad = 0.035;
  /// What may remain, rms: beyond, the poses do not belong together.
  PoseNoise max_residual{0.01, 0.05};
};

/// Of an estimated pose a_T_b: a small shift of its origin [m] and a small turn [rad], in this
/// order and along the axes of a.
using PoseCovariance = Eigen::Matrix<double, 6, 6>;

/// Where the tracker stands and how the body sits on the flange.
struct HandEye {
  Eigen::Isometry3d flange_T_body = Eigen::Isometry3d::Identity();
  Eigen::Isometry3d base_T_tracker = Eigen::Isometry3d::Identity();
  /// By which tracker_T_body is missed: rms of the distances and of the angles.
  double residual_rms_m = 0, residual_rms_rad = 0;
  std::size_t worst_pose = 0;  // index of the one that is missed most, measured by `noise`
  double worst_m = 0, worst_rad = 0;
  double spread_rad = 0;  // of the orientations about their second axis, rms
  PoseNoise noise;        // the one that was stated, or what the residuals show
  PoseCovariance flange_T_body_covariance = PoseCovariance::Zero();
  PoseCovariance base_T_tracker_covariance = PoseCovariance::Zero();
  PoseCovariance cross_covariance =
      PoseCovariance::Zero();  // rows of the body, columns of the tracker

  /// Of a point that the tracker sees there, told in the base frame by base_T_tracker: what the
  /// calibration adds to the tracker's own error, to first order.
  PointError error_at(const Eigen::Vector3d& point_in_base) const;
  /// Of a point fixed to the body, told in the flange's frame by flange_T_body.
  PointError body_error_at(const Eigen::Vector3d& point_in_flange) const;
  /// Of a point fixed to the body that the arm brings, with the flange there, to where the tracker
  /// sees another: what both together add, in the base frame. Their errors belong together, and
  /// where the calibration's poses are near they nearly cancel.
  PointError guided_error_at(const Eigen::Vector3d& point_in_flange,
                             const Eigen::Isometry3d& base_T_flange) const;
};

/// Solves base_T_flange flange_T_body = base_T_tracker tracker_T_body for all poses at once (A X =
/// Z B): from the closed form of robot_world.hpp to the least sum of squares of positions and
/// rotations, each over its noise. Without a stated noise the two are weighed by what remains of
/// each per degree of freedom (variance components), so an arm that is less exact than the tracker
/// is allowed for.
///
/// Refuses with a reason that names it (poses are counted from 1): fewer than three poses, a pose
/// that is not finite or no rotation, orientations that turn about one axis only or hardly at all,
/// poses that do not belong together, a pose that does not fit the others. Allocates.
Expected<HandEye> calibrate_hand_eye(std::span<const HandEyePose> poses,
                                     const HandEyeOptions& options = {});

}  // namespace armature
