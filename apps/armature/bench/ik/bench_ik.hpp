// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "arm_choice.hpp"

namespace armature {

struct BenchOptions {
  ArmChoice arm;
  std::vector<std::string> plugins;  // empty: every one of kind ik
  std::string params;                // YAML map from a plugin's id to its parameters
  int poses = 10000;
  std::uint64_t seed = 1;
  bool near_only = false;
  int repetitions = 5;
  double tolerance = 1e-6;         // [m] and [rad]
  std::string baseline;            // empty: ik/kdl if it is one of them, else the first
  std::optional<std::string> out;  // folder; none: no files
  bool json = false;
};

/// `armature bench ik`: every solver asked for the same poses in one run. A solver that does not
/// serve the robot is listed with its reason.
int bench_ik(const BenchOptions& options);

}  // namespace armature
