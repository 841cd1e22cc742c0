// SPDX-License-Identifier: Apache-2.0
#include "operated_system.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <stdexcept>

#include "armature/values/chance.hpp"
#include "armature/values/file_content.hpp"
#include "armature/values/temporary_folder.hpp"
#include "held_up_threads.hpp"
#include "tests/dds_domain.hpp"

namespace armature::test {
namespace {

/// Bodies that are hidden for a while, a jaw that moves and a tracker that is knocked aside.
std::vector<std::string> tracker_settings(int seed) {
  Chance chance(seed);
  const auto up_to = [&](double most) { return chance.between(0, most); };
  constexpr double kRun_s = 150;
  const std::string params = "components.tracker.params.";
  std::vector<std::string> settings;
  for (const char* body : {"flange", "jaw"}) {
    std::string times;
    double from_s = 20;  // the tools are turned in the hand before
    for (auto left = static_cast<int>(up_to(4)); left > 0; --left) {
      from_s += up_to(kRun_s / 4);
      const double until_s = from_s + up_to(1.5);
      times += fmt::format("{}{:.3f}, {:.3f}", times.empty() ? "" : ", ", from_s, until_s);
      from_s = until_s;
    }
    settings.push_back(fmt::format("{}{}_hidden_s=[{}]", params, body, times));
  }
  for (const char* what : {"jaw", "stand"}) {
    if (up_to(1) < 0.5) continue;
    settings.push_back(fmt::format("{}{}_shift_mm=[{:.3f}, {:.3f}, {:.3f}]", params, what,
                                   up_to(4) - 2, up_to(4) - 2, up_to(4) - 2));
    settings.push_back(fmt::format("{}{}_shift_at_s={:.3f}", params, what, up_to(kRun_s)));
  }
  return settings;
}

}  // namespace

OperatedRun run_with(const OperatedSystem& system, int seed) {
  static const int kDomain = unique_dds_domain();  // one run at a time
  const TemporaryFolder folder;
  const std::string file = folder / "chronicle", params = "components.operator.params.";
  DeploymentStart start{
      .files = {source_file(system.file), source_file("tests/by_lot/any_operator.yaml")},
      .settings = system.settings,
      .domain = kDomain};
  const bool aborts = seed % 4 == 0;
  start.settings.insert(start.settings.end(),
                        {params + "file=" + file, params + "seed=" + std::to_string(seed),
                         params + "aborts=" + (aborts ? "true" : "false"),
                         params + "mishaps=" + std::to_string(system.mishaps)});
  if (system.plan_changes) {
    start.settings.push_back("components.planner.params.seed=" + std::to_string(seed));
  }
  if (system.tracker_fails) {
    const auto settings = tracker_settings(seed);
    start.settings.insert(start.settings.end(), settings.begin(), settings.end());
  }
  if (seed % 3 == 2) {
    const auto settings = held_up_threads(seed, 0.02, 0.03);
    start.settings.insert(start.settings.end(), settings.begin(), settings.end());
  }
  start.options.environment["ARMATURE_PLUGIN_PATH"] = TEST_PLUGINS;
  OperatedRun operated{.run = run_deployment(start), .chronicle = {}};
  if (!std::filesystem::exists(file)) throw std::runtime_error{operated.run.text()};
  operated.chronicle = read_operator_chronicle(content_of(file));
  return operated;
}

std::vector<OperatedSystem> operated_systems() {
  std::vector<OperatedSystem> all{
      OperatedSystem{
          .name = "Tour",
          .file = "tests/faults/tour.yaml",
          .robot = "med7.yaml",
          .settings = {"components.task.params.rounds=3", "components.task.params.rest_s=0.5"},
          .rests_while = {"waiting", "resting"},
          .stops_within_s = 1.2},
      OperatedSystem{.name = "Biopsy",
                     .file = "configs/sr1_biopsy.yaml",
                     .robot = "sr1_needle.yaml",
                     .rests_while = {"registering", "at target"},
                     .body = Body::head,
                     .leads_out = true},
      OperatedSystem{.name = "TouchedBiopsy",
                     .file = "configs/sr1_touching.yaml",
                     .robot = "sr1_needle.yaml",
                     .settings = {"run.time_limit_s=60"},
                     .rests_while = {"at target"},
                     .body = Body::head,
                     .hand_leads = true,
                     .ends_well = false,
                     .seeds = 3},
      OperatedSystem{
          .name = "Implant",
          .file = "configs/dental_implant.yaml",
          .robot = "med7.yaml",
          .settings = {"components.operator.robot=arm", "components.operator.params.words=60",
                       "components.task.params.calibration_poses=12"},
          .rests_while = {"pivoting", "registering", "locating", "changing tool"},
          .stops_within_s = 1.5,
          .body = Body::jaw,
          // The hand that turns the tools does not wait for a task that is paused.
          .but_for = "pivot: the tracker has not seen",
          .seeds = 4,
          .leads_out = true},
      OperatedSystem{.name = "Teleoperation",
                     .file = "configs/master_manipulator.yaml",
                     .robot = "med7_scope.yaml",
                     .settings = {"components.operator.robot=follower",
                                  "components.leader_motion.in.rearm=motion/rearm"},
                     .rests_while = {"waiting", "aligning", "aligned", "clutch open"},
                     .stops_within_s = 0.4,
                     .body = Body::incision,
                     .ends_well = false,
                     .seeds = 4},
      OperatedSystem{.name = "Lamp",
                     .file = "configs/dental_lamp.yaml",
                     .robot = "dental_lamp.yaml",
                     // Its pictures take long to be drawn: a lamp that is left unreachable comes to
                     // this limit while the test still waits.
                     .settings = {"components.operator.params.words=10", "run.time_limit_s=90"},
                     .rests_while = {"checking light"},
                     .seeds = 1}};
  for (std::size_t i = 0, alone = all.size(); i < alone; ++i) {
    OperatedSystem stopped = all[i];
    stopped.name = "Stopped" + stopped.name;
    stopped.mishaps = 4;
    stopped.seeds = std::min(stopped.seeds, 4);
    all.push_back(stopped);
    if (all[i].name == "Biopsy") {
      OperatedSystem replanned = all[i];
      replanned.name = "Replanned" + replanned.name;
      replanned.settings = {"components.head.out={plan: head/planned}",
                            "components.planner={plugin: test/second_thoughts, in: {planned: "
                            "head/planned}}"};
      replanned.plan_changes = true;
      replanned.seeds = 20;
      all.push_back(replanned);
    }
    if (all[i].body != Body::jaw) continue;
    OperatedSystem blinded = all[i];
    blinded.name = "Blinded" + blinded.name;
    blinded.tracker_fails = true;
    blinded.ends_well = false;
    all.push_back(blinded);
  }
  return all;
}

}  // namespace armature::test
