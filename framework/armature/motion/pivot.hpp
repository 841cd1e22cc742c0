// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Geometry>
#include <optional>

#include "armature/robot/kinematics/remote_centre.hpp"
#include "armature/robot/trajectories/trajectory.hpp"
#include "armature/values/inline_text.hpp"

namespace armature ARMATURE_EXPORT {

/// How strictly a shaft keeps to an incision, all in [m].
struct PivotOptions {
  double max_deviation = 1e-4;  // of the shaft's line from the incision, on any way that is made
  double max_offset = 1e-3;     // a shaft that passes it farther away is not moved about it
  double min_depth = 0.01;      // of the tip: nearer to the incision every tilt is a fast one
};

/// Keeps the ways of an arm to the incision that its instrument's shaft is in. Real-time safe.
class Pivot {
 public:
  /// Keeps a reference to `model`, which must name a shaft.
  Pivot(const RobotModel& model, const PivotOptions& options)
      : model_{model}, options_{options}, centre_{.shaft = *model.shaft()} {}

  /// In the base frame [m]; until it is told the shaft is free.
  void set_incision(const Eigen::Vector3d& point);
  const std::optional<Eigen::Vector3d>& incision() const { return incision_; }

  /// Why the arm cannot pivot about the incision from `q`, or empty: the shaft passes beside it, or
  /// the incision is not between the tip and the end of the straight shaft.
  ReasonText refusal(const JointVector& q) const;

  /// Why the tip must not be where `base_T_tool` has it, or empty: too near to the incision, or
  /// deeper than the shaft is long.
  ReasonText depth_defect(const Eigen::Isometry3d& base_T_tool) const;
  /// As RemoteCentre::pivoted.
  Eigen::Isometry3d pivoted(const Eigen::Isometry3d& base_T_tool) const {
    return centre_.pivoted(base_T_tool);
  }

  /// [m] Of the shaft's line from the incision, at `q`.
  double deviation(const JointVector& q) const;
  /// [m] What a way that begins at `from` may leave the incision by: a shaft that passes it farther
  /// away may come back, but go no further.
  double allowed_deviation(const JointVector& from) const;
  /// Empty, or by how much `way` leaves the incision. It is looked at closely enough for a smooth
  /// way: in every piece at its end and at seven instants before that.
  ReasonText defect(const TrajectoryView& way, double allowed) const;
  /// How much of the straight way in joint space from one position to another one may go: 1, or so
  /// little that it stays within half of what is allowed, nearly.
  double share_of_way(const JointVector& from, const JointVector& to) const;

 private:
  const RobotModel& model_;
  PivotOptions options_;
  RemoteCentre centre_;
  std::optional<Eigen::Vector3d> incision_;
};

}  // namespace armature
