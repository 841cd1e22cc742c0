// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Geometry>
#include <optional>
#include <vector>

#include "armature/robot/geometry/pose_goal.hpp"
#include "armature/robot/model/joint_vector.hpp"

namespace armature::report::teleoperation {

/// Watches the leader on its way to the instrument.
class AlignmentMonitor {
 public:
  void see_rates(const JointVector& v) {
    peak_ = peak_.size() == v.size() ? JointVector{peak_.cwiseMax(v.cwiseAbs())} : v.cwiseAbs();
  }
  void see_leader(const Eigen::Isometry3d& leader_T_hand) { leader_T_hand_ = leader_T_hand; }

  /// How far the leader is from the instrument: in [m] and [rad].
  std::optional<PoseResidual> error(const Eigen::Isometry3d& follower_T_leader,
                                    const Eigen::Isometry3d& follower_T_tool) const;
  /// The largest part by which a joint's peak speed differs from that of the reference; none
  /// without a reference of so many joints.
  std::optional<double> peak_speed_error(const std::vector<double>& reference) const;

 private:
  JointVector peak_;
  std::optional<Eigen::Isometry3d> leader_T_hand_;
};

}  // namespace armature::report::teleoperation
