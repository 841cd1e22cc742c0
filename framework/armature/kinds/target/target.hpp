// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <string_view>

#include "armature/kinds/made_for_robot.hpp"
#include "armature/values/expected.hpp"
#include "armature/values/time.hpp"

namespace armature {

/// One look at the target, in the base frame.
struct TargetMeasurement {
  Time stamp;
  Eigen::Vector3d position;  // [m] the mouth
  Eigen::Vector3d normal;    // unit
  double position_sigma_m = 0, normal_sigma_rad = 0;
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
  static constexpr int kKindVersion = 1;
  using Factory = MadeFromParams<TargetFilter>;

  /// The filter's whole memory, owned by the caller; value-initialised means "not started".
  struct State {
    bool started = false;
    Time stamp;
    int measurements = 0;
    int rejected = 0;     // in a row
    double surprise = 1;  // smoothed normalised innovation: about 1 while the model holds
    bool moving = false;
    Eigen::Matrix<double, 12, 1> mean = Eigen::Matrix<double, 12, 1>::Zero();
    Eigen::Matrix<double, 12, 12> covariance = Eigen::Matrix<double, 12, 12>::Zero();
  };

  virtual ~TargetFilter() = default;
  /// Takes in a measurement; a reason when it was rejected (older than the state, an outlier).
  virtual Expected<TargetEstimate> update(const TargetMeasurement& measurement,
                                          State& state) const = 0;
  /// The estimate at `when`, or a reason (not started, too long without a measurement).
  virtual Expected<TargetEstimate> predict(Time when, const State& state) const = 0;
};

}  // namespace armature
