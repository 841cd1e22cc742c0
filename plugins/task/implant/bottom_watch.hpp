// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Geometry>
#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "armature/robot/geometry/guided_chain.hpp"

namespace armature::task::implant {

/// How near the drill's tip has come to the bottom of every site, by where the arm says that it is:
/// a motion that has come to its end has not been everywhere on its way when the arm lags.
class BottomWatch {
 public:
  BottomWatch() = default;
  BottomWatch(const GuidedChain& chain, const std::vector<Eigen::Isometry3d>& image_T_sites);

  void see(const Eigen::Isometry3d& base_T_flange);
  /// Of the first `sites`, the one that was missed by most, when that is more than `max_m`: "the
  /// drill came no nearer than 3.13 mm to the bottom of site 2, 0.3 mm are allowed"; or nullopt.
  std::optional<std::string> missed(std::size_t sites, double max_m) const;

 private:
  Eigen::Vector3d flange_tip_ = Eigen::Vector3d::Zero();
  struct Bottom {
    Eigen::Vector3d point;  // in the base frame
    double min_distance_m;
  };
  std::vector<Bottom> bottoms_;
};

}  // namespace armature::task::implant
