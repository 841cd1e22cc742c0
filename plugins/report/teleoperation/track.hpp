// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <vector>

namespace armature::report::teleoperation {

/// Where a point was at a time.
struct TrackPoint {
  double t = 0;  // [s]
  Eigen::Vector3d position = Eigen::Vector3d::Zero();
};
/// In the order of time.
using Track = std::vector<TrackPoint>;

}  // namespace armature::report::teleoperation
