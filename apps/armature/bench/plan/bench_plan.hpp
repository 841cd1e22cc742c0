// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "arm_choice.hpp"

namespace armature {

struct PlanBenchOptions {
  ArmChoice arm;
  std::vector<std::string> plugins;  // empty: every one of kind trajectory
  std::string params;                // YAML map from a plugin's id to its parameters
  int motions = 1000;
  int keys = 5;  // of an orientation curve
  std::uint64_t seed = 1;
  int repetitions = 5;
  bool json = false;
};

/// `armature bench plan`: every trajectory planner on the same joint motions of a robot, Orocos
/// KDL's trapezoid beside them, and every orientation interpolator on the same keys, in one run.
int bench_plan(const PlanBenchOptions& options);

}  // namespace armature
