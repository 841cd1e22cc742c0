// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Geometry>
#include <optional>

#include "armature/robot/guided_chain.hpp"

namespace armature {

/// Watches a drill at one site.
class BoreMonitor {
 public:
  /// The drill is inside when it is nearer than `depth_m` to the bottom.
  BoreMonitor(const Eigen::Isometry3d& image_T_site, double depth_m)
      : image_T_site_{image_T_site}, depth_m_{depth_m} {}

  const Eigen::Isometry3d& image_T_site() const { return image_T_site_; }
  void see(const Eigen::Isometry3d& base_T_flange, const GuidedChain& estimate,
           const GuidedChain& truth);

  /// Where the drill was deepest along the site's true axis: its tip from the site [m], in the base
  /// frame, and its axis against the site's. None before it came near.
  const std::optional<Eigen::Vector3d>& error() const { return error_; }
  double axis_error_rad() const { return axis_error_rad_; }
  /// As the arm believed, the farthest off the site's axis and the most tilted against it inside.
  double line_deviation_m() const { return deviation_m_; }
  double line_tilt_rad() const { return tilt_rad_; }

 private:
  Eigen::Isometry3d image_T_site_;
  double depth_m_;
  double deepest_m_ = 0;
  std::optional<Eigen::Vector3d> error_;
  double axis_error_rad_ = 0, deviation_m_ = 0, tilt_rad_ = 0;
};

}  // namespace armature
