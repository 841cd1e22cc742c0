// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Geometry>
#include <deque>
#include <optional>
#include <string>
#include <vector>

#include "armature/kinds/target/target.hpp"

namespace armature::host::target {

/// Sees what no pair of pictures shows: cameras turned sideways, of other focal lengths or another
/// baseline than stated, or a rig that was knocked as a whole. With any of them a face that rests
/// is elsewhere from near than from afar, and always so. Each two places, one after the other, from
/// which the arm at rest has seen the face tell how much; how much people stir is learned from what
/// the pairs of places do not have in common.
class ViewAgreement {
 public:
  explicit ViewAgreement(double baseline_m) : baseline_m_{baseline_m} {}

  /// A measurement in the base frame, and where the left camera was.
  void add(const Eigen::Isometry3d& base_T_left, const TargetMeasurement& measured);
  /// Tells the operator, once five pairs of places agree, that the cameras are wrong; or "".
  const std::string& warning() const { return warning_; }

 private:
  /// The face from where the arm rested.
  struct View {
    TargetMeasurement face;
    Eigen::Isometry3d base_T_left;
  };
  struct Pair {
    Eigen::Vector3d apart;       // [m] the face from the later view to the earlier one
    Eigen::Matrix3d covariance;  // [m2] of that
    Eigen::Matrix<double, 3, 6> by_cause;
  };
  void take(const View& view);
  /// The size that each cause needs to explain the pairs, where it does; or "".
  std::string causes() const;

  double baseline_m_;
  std::vector<TargetMeasurement> looks_;  // since the arm came to rest
  Eigen::Isometry3d rests_at_ = Eigen::Isometry3d::Identity();
  std::optional<View> last_;
  std::deque<Pair> pairs_;
  std::string warning_;
};

}  // namespace armature::host::target
