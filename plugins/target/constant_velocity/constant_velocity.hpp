// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>

#include "armature/kinds/target/target.hpp"

namespace armature {

/// Kalman filter of a point and a normal with their rates, in the base frame. It has two models of
/// how the target moves, and the innovations choose: "still", in which the rates decay and
/// measurements are averaged, and "moving", in which the rates are kept and driven by accelerations
/// (see README).
class ConstantVelocity final : public TargetFilter {
 public:
  struct Settings {
    double still_speed_m_s = 0.0003, still_turn_rad_s = 0.005;  // standard deviations
    double acceleration_m_s2 = 0.3, turn_acceleration_rad_s2 = 1;
    double decay_s = 0.5;   // of the rates while still
    double surprise = 2.5;  // smoothed normalised innovation above which the target moves
    double outlier_position_m = 0.15, outlier_angle_rad = 0.785;  // farther off is not believed
    int restart_after = 4;   // outliers in a row: the target has been moved, start again there
    double max_gap_s = 1.0;  // longest prediction
  };

  explicit ConstantVelocity(const Settings& settings) : settings_{settings} {}
  static Expected<std::unique_ptr<TargetFilter>> make(const Params& params);

  Expected<TargetEstimate> update(const TargetMeasurement& measurement,
                                  State& state) const override;
  Expected<TargetEstimate> predict(Time when, const State& state) const override;

 private:
  void start(const TargetMeasurement& measurement, State& state) const;
  void advance(State& state, double dt_s, bool moving) const;

  Settings settings_;
};

}  // namespace armature
