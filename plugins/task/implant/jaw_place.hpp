// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Geometry>
#include <optional>
#include <string>
#include <vector>

#include "pose_average.hpp"
#include "task_implant_parameters.hpp"

namespace armature::task::implant {

/// Where the jaw is, as an average of what the tracker sees, and whether it has moved since. A jaw
/// that moves meanwhile is no noise, which a mean would take down.
class JawPlace {
 public:
  explicit JawPlace(const Parameters& parameters) : parameters_{parameters} {}

  /// Once more from the first sample. `ends`: of the bores, in the jaw's frame [m], where it is
  /// told by how much it has moved.
  void locate(std::vector<Eigen::Vector3d> ends);
  /// While it is averaged: how it has moved, when it must not, or how its samples scatter, or
  /// nullopt.
  std::optional<std::string> see(const Eigen::Isometry3d& tracker_T_jaw);
  bool located() const { return average_.count() >= parameters_.jaw_samples; }
  const PoseAverage& average() const { return average_; }
  /// Of the bores, in the jaw's frame [m].
  const std::vector<Eigen::Vector3d>& ends() const { return ends_; }
  /// Later: the same, against where it was.
  std::optional<std::string> guard(const Eigen::Isometry3d& tracker_T_jaw);

 private:
  /// By how much the jaw has moved [m], where that is most.
  double max_moved(const Eigen::Isometry3d& tracker_T_jaw, const Eigen::Isometry3d& from) const;
  /// Of one sample [m, rms], where that is most.
  double max_scatter() const;

  Parameters parameters_;
  std::vector<Eigen::Vector3d> ends_;
  PoseAverage average_, now_;
  std::optional<Eigen::Isometry3d> first_;  // the mean of the first samples
};

}  // namespace armature::task::implant
