// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <string>

#include "armature/kinds/trajectory/trajectory_planner.hpp"

namespace armature::bench {

/// What is measured: something that plans a motion, keeps the plan, and tells where it is when.
class Planner {
 public:
  virtual ~Planner() = default;
  /// False: it cannot plan this one.
  virtual bool plan(const TrajectoryRequest& request) = 0;
  /// Of the last plan [s].
  virtual double duration_s() const = 0;
  /// q, v and a of all joints at `t` [s]; returns a number that depends on them.
  virtual double sample(double t) const = 0;
};

/// A plugin's planner, which outlives the result.
std::unique_ptr<Planner> plugin_planner(const TrajectoryPlanner& planner);

/// One trapezoidal velocity profile of Orocos KDL per joint, all as long as the slowest's: the
/// peer. Its acceleration jumps; only point to point.
std::unique_ptr<Planner> kdl_trapezoid();
inline constexpr const char* kKdlTrapezoid = "KDL VelocityProfile_Trap";

}  // namespace armature::bench
