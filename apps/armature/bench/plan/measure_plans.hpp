// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "bench/allocations.hpp"
#include "bench/plan/motions.hpp"
#include "bench/plan/planners.hpp"

namespace armature::bench {

struct NamedPlanner {
  std::string name;
  std::unique_ptr<Planner> planner;
};

/// A planner and one shape of motions, in one line.
struct PlanRow {
  std::string name;
  Shape shape = Shape::point_to_point;
  int planned = 0, refused = 0;
  double plan_median_s = 0, plan_p99_s = 0;
  double sample_s = 0;                // median over motions of the mean of 64 samples
  double allocations = 0;             // per plan
  std::optional<double> times_least;  // median of duration / least possible; point to point only
};

struct MeasurePlansOptions {
  int repetitions = 5;
  std::uint64_t order = 1;  // seed of the order of work
  AllocationCounter allocations = nullptr;
  std::function<void(double part)> progress;  // 0 to 1
};

/// Every planner asked for every motion: once without a clock (counted, caches warm), then
/// `repetitions` times with it, 50 motions at a time, the planners taking turns in random order. Of
/// each plan and each motion's samples the least of all repetitions counts, the clock's own time
/// taken off.
std::vector<PlanRow> measure_plans(const std::vector<NamedPlanner>& planners, Shape shape,
                                   const std::vector<Motion>& motions,
                                   const MeasurePlansOptions& options);

}  // namespace armature::bench
