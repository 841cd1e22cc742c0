// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Geometry>
#include <cstddef>
#include <optional>
#include <string>
#include <vector>

namespace armature::task::implant {

/// Where a tool has to come to.
struct Destination {
  Eigen::Vector3d flange_tip;   // [m] of the tool
  Eigen::Vector3d base_bottom;  // [m]
};

/// How near a tool's tip has come to the bottom of every site, by where the arm says that it is:
/// a motion that has come to its end has not been everywhere on its way when the arm lags.
class BottomWatch {
 public:
  BottomWatch() = default;
  /// `tool` and `at` as in "the drill", "the bottom of".
  BottomWatch(const std::vector<Destination>& destinations, std::string tool, std::string at);

  void see(const Eigen::Isometry3d& base_T_flange);
  /// Of the first `sites`, the one that was missed by most, when that is more than `max_m`: "the
  /// drill came no nearer than 3.13 mm to the bottom of site 2, 0.3 mm are allowed"; or nullopt.
  std::optional<std::string> missed(std::size_t sites, double max_m) const;

 private:
  struct Bottom : Destination {
    double min_distance_m;
  };
  std::vector<Bottom> bottoms_;
  std::string tool_, at_;
};

}  // namespace armature::task::implant
