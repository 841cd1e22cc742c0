// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <optional>
#include <string>

#include "armature/kinds/target/target.hpp"
#include "target_constant_velocity_parameters.hpp"

namespace armature::target::constant_velocity {

/// Kalman filter of a point and a normal with their rates, in the base frame. It has two models of
/// how the target moves, and the innovations choose: "still", in which the rates decay and
/// measurements are averaged, and "moving", in which the rates are kept and driven by accelerations
/// (see README).
class ConstantVelocity final : public TargetFilter {
 public:
  explicit ConstantVelocity(const Parameters& parameters) : parameters_{parameters} {}
  static Expected<std::unique_ptr<TargetFilter>> make(const Params& params);

  Expected<TargetEstimate> update(const TargetMeasurement& measurement,
                                  PluginState& state) const override;
  Expected<TargetEstimate> predict(Time when, const PluginState& state) const override;

 private:
  struct Belief;
  Belief started_at(const TargetMeasurement& measurement) const;
  Expected<Belief> updated(const TargetMeasurement& told, Belief& belief) const;
  /// Why this measurement alone is not believed of a target that was as `belief` says and is
  /// `predicted` where it goes on.
  struct Outlier;
  std::optional<Outlier> outlier(const TargetMeasurement& measurement, const Belief& belief,
                                 const Belief& predicted) const;
  void advance(Belief& belief, double dt_s, bool moving) const;

  Parameters parameters_;
};

}  // namespace armature::target::constant_velocity
