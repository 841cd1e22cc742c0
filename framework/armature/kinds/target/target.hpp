// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <string_view>

#include "armature/kinds/made_for_robot.hpp"
#include "armature/values/expected.hpp"
#include "armature/values/plugin_state.hpp"
#include "armature/values/time.hpp"

namespace armature ARMATURE_EXPORT {

/// One look at the target, in the base frame.
struct TargetMeasurement {
  Time stamp;
  Eigen::Vector3d position;                                       // [m] the mouth
  Eigen::Vector3d normal;                                         // unit
  Eigen::Matrix3d position_covariance = Eigen::Matrix3d::Zero();  // [m2]
  Eigen::Matrix3d normal_covariance = Eigen::Matrix3d::Zero();    // [rad2] across the normal
};

/// Where the target is and how it moves, in the base frame.
struct TargetEstimate {
  Time stamp;
  Eigen::Vector3d position;                               // [m]
  Eigen::Vector3d normal;                                 // unit
  Eigen::Vector3d velocity = Eigen::Vector3d::Zero();     // [m/s]
  Eigen::Vector3d normal_rate = Eigen::Vector3d::Zero();  // [1/s] d(normal)/dt
  int measurements = 0;  // that went into it since it was last started
};

/// Filters measurements of a target and predicts between them.
class TargetFilter {
 public:
  static constexpr std::string_view kKind = "target";
  using Factory = MadeFromParams<TargetFilter>;

  virtual ~TargetFilter() = default;
  /// Takes in a measurement; a reason when it was rejected (older than the newest one, an outlier).
  /// All that the filter remembers is in `state`.
  virtual Expected<TargetEstimate> update(const TargetMeasurement& measurement,
                                          PluginState& state) const = 0;
  /// The estimate at `when`, or a reason (nothing measured yet, too long without a measurement).
  virtual Expected<TargetEstimate> predict(Time when, const PluginState& state) const = 0;
};

}  // namespace armature
