// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "armature/robot/model/joint_vector.hpp"
#include "armature/robot/trajectories/quintic.hpp"

namespace armature ARMATURE_EXPORT {

/// A curve q(s) through waypoints with continuous derivatives up to the fourth: the geometry of a
/// joint path, without time. Two waypoints are a straight line.
class JointCurve {
 public:
  /// `s` ascending from 0 to 1; at least two waypoints.
  JointCurve(std::vector<double> s, std::vector<JointVector> q);

  const std::vector<double>& s() const { return s_; }
  const std::vector<JointVector>& waypoints() const { return q_; }
  int dof() const { return static_cast<int>(q_.front().size()); }
  /// q and, in `v` and `a`, its first and second derivative by s.
  JointState at(double s) const;

 private:
  std::vector<double> s_;
  std::vector<JointVector> q_;
  std::vector<Quintic> pieces_;
};

}  // namespace armature
