// SPDX-License-Identifier: Apache-2.0
#include "bench/perception/bench_perception.hpp"

#include <fmt/format.h>

#include <cstdio>
#include <filesystem>
#include <string>
#include <vector>

#include "armature/runtime/plugins/running_component.hpp"
#include "armature/runtime/reporting/output_folder.hpp"
#include "armature/runtime/reporting/write_atomically.hpp"
#include "bench/perception/cases.hpp"
#include "bench/perception/measure_pairs.hpp"
#include "bench/perception/perception_report.hpp"
#include "bench/perception/worst_pairs.hpp"
#include "exit_code.hpp"
#include "progress.hpp"
#include "standard_output.hpp"

namespace armature {
namespace {

/// Those of the groups that were asked for; the same ones as in a run of all groups.
std::vector<bench::PerceptionCase> chosen_cases(const StereoCamera& camera,
                                                const PerceptionBenchOptions& options) {
  auto cases = bench::perception_cases(camera, options.pairs, options.seed);
  std::string names, last;
  for (const bench::PerceptionCase& one : cases) {
    if (one.group != last) names += "\n  " + one.group;
    last = one.group;
  }
  std::erase_if(cases, [&](const bench::PerceptionCase& one) {
    return one.group.find(options.group) == std::string::npos;
  });
  if (!cases.empty()) return cases;
  throw InvalidChoice(
      fmt::format("no group has '{}' in its name; these are there:{}", options.group, names));
}

}  // namespace

int bench_perception(const PerceptionBenchOptions& options) {
  if (options.worst) prepare_output_folder(*options.worst);
  if (options.csv) prepare_output_folder(std::filesystem::absolute(*options.csv).parent_path());
  PluginRegistry registry;
  name_crashing_components();
  const bench::ChosenPerception chosen =
      bench::chosen_perception(registry, options.source, options.choice);
  const auto cases = chosen_cases(chosen.camera, options);
  std::vector<bench::PairResult> results;
  {
    Progress progress{"stereo pairs"};
    results = bench::measure_pairs(
        cases,
        {.detector = *chosen.detector,
         .landmarks = *chosen.landmarks,
         .estimator = *chosen.face_pose,
         .of_estimator = chosen.frontal_landmarks ? &*chosen.frontal_landmarks : nullptr,
         .search = chosen.search},
        [&](std::size_t done) { progress.of(done, cases.size()); });
  }
  const bench::PerceptionReport report{.detector = chosen.detector_id,
                                       .landmarks = chosen.landmarks_id,
                                       .face_pose = chosen.face_pose_id,
                                       .deployment = chosen.deployment,
                                       .rig = chosen.rig,
                                       .seed = options.seed,
                                       .machine = bench::this_machine(),
                                       .rows = bench::rows_of(results),
                                       .stages = bench::stages_of(results)};
  print_out("{}", options.json ? to_json(report) + "\n" : table(report));
  std::fflush(standard_output());  // also when the files cannot be written
  if (options.csv) write_atomically(*options.csv, bench::csv_of(results), FileUse::named_by_user);
  if (options.worst) bench::write_worst_pairs(*options.worst, cases, results);
  return kOk;
}

}  // namespace armature
