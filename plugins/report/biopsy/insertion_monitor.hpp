// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Geometry>
#include <optional>
#include <utility>
#include <vector>

#include "armature/robot/geometry/forbidden_zone.hpp"
#include "armature/robot/model/joint_vector.hpp"
#include "armature/values/time.hpp"

namespace armature::report::biopsy {

/// What the registration said.
struct RegisteredNeedle {
  Eigen::Vector3d entry, target;  // [m], in the base frame
  double error_rms_m = 0, error_95_m = 0, fiducial_error_m = 0;
};

/// Watches a needle along its registered line.
class InsertionMonitor {
 public:
  /// One that is no line is none.
  void see_registration(const RegisteredNeedle& needle) {
    needle_.reset();
    if (needle.entry.allFinite() && needle.target.allFinite()) needle_ = needle;
  }
  /// Where they are in truth, in the base frame.
  void see_vessels(std::vector<ForbiddenZone> vessels) { vessels_ = std::move(vessels); }
  /// The tip, the needle's direction (unit), and the values of the joints that turn.
  void see_tip(const Eigen::Vector3d& tip, const Eigen::Vector3d& axis, const JointVector& turning);

  const std::optional<RegisteredNeedle>& needle() const { return needle_; }
  const std::optional<Eigen::Vector3d>& tip() const { return tip_; }
  /// None before the tip has come past the entry, by way of it.
  std::optional<double> line_deviation_m() const { return deviation_m_; }
  std::optional<double> line_tilt_rad() const { return tilt_rad_; }
  std::optional<double> turned_rad() const { return turned_rad_; }
  /// The least distance of the needle's axis, from the entry to the tip, from the surface of a
  /// vessel; negative inside. None where there is no vessel, too.
  std::optional<double> vessel_distance_m() const { return vessel_distance_m_; }

 private:
  std::optional<RegisteredNeedle> needle_;
  std::optional<Eigen::Vector3d> tip_;
  std::vector<ForbiddenZone> vessels_;
  std::optional<double> deviation_m_, tilt_rad_, turned_rad_, vessel_distance_m_;
  std::optional<JointVector> at_entry_;  // of the joints that turn
  bool entered_ = false;
};

}  // namespace armature::report::biopsy
