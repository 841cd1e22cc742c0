// SPDX-License-Identifier: Apache-2.0
#include "bench/plan/bench_plan.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "armature/runtime/plugins/running_component.hpp"
#include "bench/contestants.hpp"
#include "bench/plan/plan_report.hpp"
#include "exit_code.hpp"
#include "progress.hpp"
#include "standard_output.hpp"

namespace armature {
namespace {

using bench::NamedPlanner;
using bench::PlanReport;

/// The planners, whose libraries stay loaded as long as they.
struct Field {
  std::vector<PluginPtr<TrajectoryPlanner>> plugins;
  std::vector<NamedPlanner> planners;
};

/// The planners that can be made; the others go to the report.
Field field_of(const PlanBenchOptions& options, PluginRegistry& registry, PlanReport& report) {
  Field field;
  for (const bench::Contestant& one :
       bench::contestants(registry, TrajectoryPlanner::kKind, options.plugins, options.params)) {
    const std::string& id = one.plugin->id;
    if (!one.lacks.empty()) {
      report.refused.push_back({id, one.lacks});
      continue;
    }
    auto made = registry.make<TrajectoryPlanner>(id, one.params);
    if (!made) {
      report.refused.push_back({id, made.error().text});
      continue;
    }
    field.plugins.push_back(std::move(*made));
    field.planners.push_back({id, bench::plugin_planner(*field.plugins.back())});
  }
  field.planners.push_back({bench::kKdlTrapezoid, bench::kdl_trapezoid()});
  return field;
}

}  // namespace

int bench_plan(const PlanBenchOptions& options) {
  const RobotModel model = load_arm(options.arm);
  PluginRegistry registry;
  name_crashing_components();
  PlanReport report{.robot = model.name(),
                    .motions = options.motions,
                    .keys = options.keys,
                    .seed = options.seed,
                    .repetitions = options.repetitions,
                    .machine = bench::this_machine(),
                    .refused = {}};
  const Field field = field_of(options, registry, report);
  Progress progress{"plans"};
  double done = 0;
  for (const auto shape : {bench::Shape::point_to_point, bench::Shape::curve}) {
    const bench::MeasurePlansOptions how{
        .repetitions = options.repetitions,
        .order = options.seed,
        .allocations = allocation_counter(),
        .progress = [&](double part) { progress.part(0.5 * (done + part)); }};
    report.counts_allocations = how.allocations != nullptr;
    const auto rows = bench::measure_plans(
        field.planners, shape, bench::motions(model, shape, options.motions, options.seed), how);
    report.plans.insert(report.plans.end(), rows.begin(), rows.end());
    done += 1;
  }
  report.interpolators = bench::measure_interpolators(std::min(options.motions, 200), options.keys,
                                                      options.seed, options.repetitions);
  print_out("{}", options.json ? bench::to_json(report) + "\n" : bench::table(report));
  return kOk;
}

}  // namespace armature
