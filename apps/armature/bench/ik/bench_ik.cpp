// SPDX-License-Identifier: Apache-2.0
#include "bench/ik/bench_ik.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <nlohmann/json.hpp>

#include "armature/kinds/ik/verify/plugin_subject.hpp"
#include "armature/robot/kinematics/locked_joints.hpp"
#include "armature/runtime/plugins/running_component.hpp"
#include "armature/runtime/reporting/output_folder.hpp"
#include "armature/runtime/reporting/write_atomically.hpp"
#include "armature/values/json_text.hpp"
#include "bench/contestants.hpp"
#include "bench/ik/report.hpp"
#include "exit_code.hpp"
#include "progress.hpp"
#include "standard_output.hpp"

namespace armature {
namespace {

using bench::Report;
using bench::Runner;

/// The solvers that serve the robot; the others go to the report.
std::vector<Runner> runners_of(const BenchOptions& options, PluginRegistry& registry,
                               const std::shared_ptr<const RobotModel>& model, Report& report) {
  std::vector<Runner> runners;
  for (const bench::Contestant& one :
       bench::contestants(registry, IkSolver::kKind, options.plugins, options.params)) {
    const std::string& id = one.plugin->id;
    if (!one.lacks.empty()) {
      report.refused.push_back({id, one.lacks});
      continue;
    }
    const auto subject = plugin_subject(registry, *one.plugin, model, one.params);
    if (subject) {
      runners.push_back({id, subject->solver});
    } else {
      report.refused.push_back({id, subject.error().text});
    }
  }
  return runners;
}

std::string baseline_of(const BenchOptions& options, const std::vector<Runner>& runners) {
  constexpr const char* kUsual = "ik/kdl";  // what everybody knows
  const auto runs = [&](std::string_view id) {
    return std::ranges::find(runners, id, &Runner::plugin) != runners.end();
  };
  if (options.baseline.empty()) return runs(kUsual) ? kUsual : runners.front().plugin;
  if (runs(options.baseline)) return options.baseline;
  throw InvalidChoice(fmt::format(
      "the baseline '{}' is not one of the solvers that serve the robot", options.baseline));
}

void write_files(const std::filesystem::path& folder, const Report& report,
                 const std::vector<bench::Series>& series) {
  constexpr FileUse kUse = FileUse::named_by_user;
  write_atomically(folder / "solves.csv", bench::csv_of(series), kUse);
  write_atomically(folder / "cumulative.svg", bench::plot_of(report, series), kUse);
  write_atomically(folder / "summary.json", json_text(to_json(report), 2) + '\n', kUse);
}

}  // namespace

int bench_ik(const BenchOptions& options) {
  if (options.out) prepare_output_folder(*options.out);
  const auto model =
      std::make_shared<const RobotModel>(without_locked_joints(load_arm(options.arm)));
  PluginRegistry registry;
  name_crashing_components();
  Report report;
  const std::vector<Runner> runners = runners_of(options, registry, model, report);
  report.robot = model->name();
  report.tip = model->frame(model->tool()).name;
  report.poses = options.poses;
  report.seed = options.seed;
  report.tolerance = options.tolerance;
  report.repetitions = options.repetitions;
  report.machine = bench::this_machine();
  std::vector<bench::Series> series;
  if (!runners.empty()) {
    report.baseline = baseline_of(options, runners);
    Progress progress{"solves"};
    bench::MeasureOptions how{.repetitions = options.repetitions,
                              .order = options.seed,
                              .allocations = allocation_counter(),
                              .progress = [&](double part) { progress.part(part); }};
    if (options.near_only) how.seeds = {bench::Seeds::near};
    report.counts_allocations = how.allocations != nullptr;
    const auto poses = bench::poses(*model, options.poses, options.seed, options.tolerance);
    series = bench::measure(*model, runners, poses, how);
    report.rows = bench::rows_of(series, report.baseline, options.seed);
  }
  print_out("{}", options.json ? json_text(to_json(report)) + "\n" : table(report));
  std::fflush(standard_output());  // also when the files cannot be written
  if (options.out && !series.empty()) write_files(*options.out, report, series);
  if (runners.empty()) fmt::print(stderr, "armature: no solver serves this robot\n");
  return runners.empty() ? kFailed : kOk;
}

}  // namespace armature
