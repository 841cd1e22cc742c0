// SPDX-License-Identifier: Apache-2.0
#include <CLI/CLI.hpp>
#include <memory>
#include <string>

#include "bench/bus/bench_bus.hpp"
#include "bench/ik/bench_ik.hpp"
#include "bench/loop/bench_loop.hpp"
#include "bench/perception/bench_perception.hpp"
#include "bench/plan/bench_plan.hpp"
#include "bench/watched/bench_watched.hpp"
#include "verbs/option_checks.hpp"
#include "verbs/verbs.hpp"

namespace armature {
namespace {

void add_bench_plan(CLI::App* bench, Action& action) {
  auto options = std::make_shared<PlanBenchOptions>();
  CLI::App* plan = bench->add_subcommand(
      "plan",
      "Trajectories on the same motions: armature bench plan --robot configs/robots/med7.yaml");
  add_arm(plan, options->arm);
  plan->get_option("--robot")->required();
  plan->add_option("--plugins", options->plugins, "planners, 'trajectory/quintic' (all)")
      ->delimiter(',');
  plan->add_option("--params", options->params, "YAML: '{trajectory/cubic_spline: {...}}'");
  add_ranged(plan, "--motions", options->motions, "of each shape", 1, 1000000);
  add_ranged(plan, "--keys", options->keys, "of an orientation curve", 2, 1000);
  add_seed(plan, options->seed, "of the random numbers");
  add_ranged(plan, "--repetitions", options->repetitions, "of every plan", 1, 1000);
  plan->add_flag("--json", options->json, "as JSON");
  plan->callback([options, &action] { action = [options] { return bench_plan(*options); }; });
}

void add_bench_loop(CLI::App* bench, Action& action) {
  auto options = std::make_shared<LoopBenchOptions>();
  CLI::App* loop = bench->add_subcommand(
      "loop", "How late an executor's steps begin, beside a bare thread: armature bench loop");
  loop->add_option("--readers", options->readers, "other processes that read, in further rounds")
      ->check(CLI::Range(0, 32));
  loop->add_flag("--everything", options->everything,
                 "in further rounds the loop is recorded, by itself and by another process, and a "
                 "page and four others read it");
  loop->add_option("--page", options->page)->group("");  // what the bench starts
  add_ranged(loop, "--rounds", options->rounds, "of each comparison", 1, 1000);
  add_ranged(loop, "--seconds", options->seconds, "of a round: at least 1000 periods", 0.1, 3600.0);
  add_ranged(loop, "--period", options->period_s, "of the loops [s]", 1e-4, 0.1);
  add_ranged(loop, "--priority", options->priority, "of the loops, SCHED_FIFO; 0: normal", 0, 99);
  add_ranged(loop, "--domain", options->domain, "DDS domain", 0, 232);
  loop->add_flag("--json", options->json, "as JSON");
  loop->callback([options, &action] {
    if (std::string wrong = wrong_round(*options); !wrong.empty()) {
      throw CLI::ValidationError("--seconds", wrong);
    }
    action = [options] { return bench_loop(*options); };
  });
}

void add_bench_bus(CLI::App* bench, Action& action) {
  auto options = std::make_shared<BusBenchOptions>();
  CLI::App* bus = bench->add_subcommand(
      "bus", "What a topic costs beside a wake and beside Fast DDS alone: armature bench bus");
  add_ranged(bus, "--rounds", options->rounds, "of everything in turn", 1, 10000);
  add_ranged(bus, "--picture-bytes", options->picture_bytes, "size of a picture", 1, 1'900'000);
  add_ranged(bus, "--domain", options->domain, "DDS domain", 0, 232);
  bus->add_flag("--answers", options->answers)->group("");  // what the bench starts
  bus->add_flag("--json", options->json, "as JSON");
  bus->callback([options, &action] { action = [options] { return bench_bus(*options); }; });
}

void add_bench_watched(CLI::App* bench, Action& action) {
  auto options = std::make_shared<WatchedBenchOptions>();
  CLI::App* watched = bench->add_subcommand(
      "watched",
      "What it costs a deployment to be recorded and read: armature bench watched "
      "dental_lamp --set components.scene.params.rate_hz=30");
  add_source(*watched, options->source);
  add_ranged(watched, "--readers", options->readers, "other processes that read what is measured",
             0, 32);
  add_ranged(watched, "--rounds", options->rounds, "of a run each", 1, 1000);
  add_ranged(watched, "--seconds", options->seconds, "of a run", 1.0, 3600.0);
  add_ranged(watched, "--domain", options->domain, "DDS domain", 0, 232);
  watched->add_flag("--json", options->json, "as JSON");
  watched->callback([options, &action] { action = [options] { return bench_watched(*options); }; });
}

void add_bench_perception(CLI::App* bench, Action& action) {
  auto options = std::make_shared<PerceptionBenchOptions>();
  CLI::App* perception = bench->add_subcommand(
      "perception",
      "Face detector, landmarks and face pose of a deployment on drawn pairs whose truth is known: "
      "armature bench perception dental_lamp");
  add_source(*perception, options->source);
  perception->get_option("files")->required(false);
  add_ranged(perception, "--pairs", options->pairs, "in all, at least one of each group", 1,
             1000000);
  add_seed(perception, options->seed, "of the cases");
  perception->add_option("--group", options->group,
                         "only groups with this in their name, 'glasses'; their pairs are those of "
                         "a run of all");
  const char* instead = ", instead of the deployment's, with its defaults";
  perception->add_option("--detector", options->choice.detector,
                         std::string{"'detector/hog'"} + instead);
  perception->add_option("--landmarks", options->choice.landmarks,
                         std::string{"'landmarks/dlib68'"} + instead);
  perception->add_option("--face-pose", options->choice.face_pose,
                         std::string{"'face_pose/three_point'"} + instead);
  perception->add_option("--csv", options->csv, "a line per pair, into this file");
  perception->add_option("--worst", options->worst,
                         "the worst pairs as JPEG with truth and estimate, into this folder");
  perception->add_flag("--json", options->json, "as JSON");
  perception->callback([options, &action] {
    if (options->source.files.empty()) options->source.files = {"dental_lamp"};
    action = [options] { return bench_perception(*options); };
  });
}

}  // namespace

void add_bench_verbs(CLI::App& app, Action& action) {
  CLI::App* bench = app.add_subcommand("bench", "Measure plugins side by side");
  bench->require_subcommand(1);
  add_bench_plan(bench, action);
  add_bench_perception(bench, action);
  add_bench_loop(bench, action);
  add_bench_bus(bench, action);
  add_bench_watched(bench, action);
  auto options = std::make_shared<BenchOptions>();
  CLI::App* ik = bench->add_subcommand(
      "ik", "Solvers on the same goals: armature bench ik --robot configs/robots/dental_lamp.yaml");
  add_arm(ik, options->arm);
  ik->get_option("--robot")->required();
  ik->add_option("--plugins", options->plugins, "solvers, 'ik/lamp_geometric,ik/numeric' (all)")
      ->delimiter(',');
  ik->add_option("--params", options->params, "YAML: '{ik/numeric: {max_restarts: 3}}'");
  add_ranged(ik, "--poses", options->poses, "goals", 1, 10000000);
  add_seed(ik, options->seed, "of the random numbers");
  ik->add_flag("--near", options->near_only, "only seeds within 5 degrees of a solution");
  add_ranged(ik, "--repetitions", options->repetitions, "of every solve", 1, 1000);
  ik->add_option("--tolerance", options->tolerance, "of a residual, m and rad")
      ->capture_default_str()
      ->check(not_positive);
  ik->add_option("--baseline", options->baseline,
                 "what the others are compared with (ik/kdl if it is among them, else the first)");
  ik->add_option("--out", options->out, "folder for solves.csv, cumulative.svg, summary.json");
  ik->add_flag("--json", options->json, "as JSON");
  ik->callback([options, &action] { action = [options] { return bench_ik(*options); }; });
}

}  // namespace armature
