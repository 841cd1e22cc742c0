// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "bench/machine.hpp"
#include "bench/plan/interpolators.hpp"
#include "bench/plan/measure_plans.hpp"

namespace armature::bench {

/// Everything that was measured and how.
struct PlanReport {
  std::string robot;
  int motions = 0, keys = 0;
  std::uint64_t seed = 0;
  int repetitions = 0;
  bool counts_allocations = false;
  Machine machine;
  std::vector<PlanRow> plans;
  std::vector<InterpolatorRow> interpolators;
  struct Refused {
    std::string plugin, reason;
  };
  std::vector<Refused> refused;
};

std::string table(const PlanReport& report);
std::string to_json(const PlanReport& report);

}  // namespace armature::bench
