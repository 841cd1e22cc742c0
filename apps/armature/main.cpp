// SPDX-License-Identifier: Apache-2.0
// The command line. Only this file and verb_tree.cpp include CLI11.
#include <fcntl.h>
#include <fmt/format.h>
#include <unistd.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <functional>
#include <iostream>
#include <limits>

#include "armature/config/problems.hpp"
#include "calculator.hpp"
#include "calibrate.hpp"
#include "check.hpp"
#include "completion/complete.hpp"
#include "completion/script.hpp"
#include "doctor/doctor.hpp"
#include "drill/drill.hpp"
#include "exit_code.hpp"
#include "ik_bench/bench.hpp"
#include "inspect.hpp"
#include "loop_bench/bench_loop.hpp"
#include "man_page.hpp"
#include "option_checks.hpp"
#include "plan_bench/bench_plan.hpp"
#include "plugins.hpp"
#include "run.hpp"
#include "schema.hpp"
#include "shipped_configs.hpp"
#include "stop.hpp"
#include "topics.hpp"
#include "verb_tree.hpp"
#include "verify/verify.hpp"

namespace armature {
namespace {

/// What the chosen verb will do, once the whole line has been understood.
using Action = std::function<int()>;

void add_source(CLI::App& verb, DeploymentSource& source) {
  const auto to_file = [](std::string& given) {
    given = deployment_file(given);
    return std::string{};
  };
  verb.add_option("files", source.files,
                  "deployment: a file, or a name that came with armature (dental_lamp); then "
                  "overlays that change it")
      ->required()
      ->transform(CLI::Validator{to_file, ""});
  verb.add_option("--set", source.assignments,
                  "change one value: --set components.motion.ik.plugin=ik/numeric")
      ->allow_extra_args(false);
}

/// Of a verb that joins DDS from outside of any deployment.
void add_interfaces(CLI::App& verb, std::vector<std::string>& interfaces) {
  verb.add_option("--interface", interfaces,
                  "join this one beside loopback, by name or IPv4 address")
      ->allow_extra_args(false)
      ->check(no_interface);
}

/// What the main process of a deployment tells the others that it starts, and a drill the run that
/// it drills; nobody types it.
void add_handed_over(CLI::App& verb, RunOptions& options) {
  const auto origin = [&options]() -> RunOptions::Origin& {
    if (!options.origin) options.origin.emplace();
    return *options.origin;
  };
  verb.add_option("--control", options.control)->group("");
  verb.add_option("--inject", options.inject)->group("");
  verb.add_option_function<std::int64_t>(
          "--clock-offset-ns", [origin](std::int64_t ns) { origin().clock_offset = Duration{ns}; })
      ->group("");
  verb.add_option_function<std::int64_t>("--clock-start-ns",
                                         [origin](std::int64_t ns) { origin().start = Time{ns}; })
      ->group("");
}

void add_run(CLI::App& app, Action& action) {
  auto options = std::make_shared<RunOptions>();
  CLI::App* verb =
      app.add_subcommand("run", "Run a deployment; exit code 0 when its goals are met");
  add_source(*verb, options->source);
  verb->add_option("--domain", options->domain, "DDS domain, instead of the file's")
      ->check(CLI::Range(0, 232));
  verb->add_option("--process", options->process, "run only this process of the deployment");
  verb->add_flag("--json", options->json, "print the result as one JSON object");
  verb->add_flag("--timing", options->timing, "tell how late and how long every step was");
  verb->add_flag("--keep-running", options->keep_running,
                 "go on when the scenario is over, until Ctrl-C: to watch it");
  verb->add_option("--report", options->report,
                   "write report.json, tables and pictures into this folder");
  add_handed_over(*verb, *options);
  verb->callback([options, &action] { action = [options] { return run_deployment(*options); }; });
}

void add_drill(CLI::App& app, Action& action) {
  auto options = std::make_shared<DrillOptions>();
  CLI::App* verb = app.add_subcommand(
      "drill", "Pull the plugs of a deployment whose arms are simulated, while they move");
  add_source(*verb, options->source);
  verb->add_option("--moments", options->moments, "at which each fault is fired")
      ->capture_default_str()
      ->check(CLI::Range(1, 1000));
  verb->add_option("--within", options->within_s,
                   "the moments lie in so many seconds after an arm was first seen to move")
      ->capture_default_str()
      ->check(wrong_number)
      ->check(CLI::Range(0.0, 100.0));
  verb->add_option("--seed", options->seed, "of the moments (another one every time)")
      ->check(wrong_seed);
  verb->add_option("--faults", options->faults, "only these, 'interrupt,motion_killed' (all)")
      ->delimiter(',');
  verb->add_option("--jobs", options->jobs, "runs at the same time")
      ->capture_default_str()
      ->check(CLI::Range(1, 16));
  verb->add_option("--domain", options->domain,
                   "DDS domain of all runs, which are then one at a time (any that is free)")
      ->check(CLI::Range(0, 232));
  verb->add_flag("--short", options->brief, "a random choice of faults, half a minute");
  verb->add_flag("--json", options->json, "as JSON");
  verb->callback([options, &action] { action = [options] { return run_drill(*options); }; });
}

void add_stop(CLI::App& app, Action& action) {
  auto options = std::make_shared<StopOptions>();
  CLI::App* verb = app.add_subcommand(
      "stop", "Stop every arm of a DDS domain: they stay stopped until they are rearmed");
  verb->add_option("--domain", options->domain, "DDS domain")
      ->capture_default_str()
      ->check(CLI::Range(0, 232));
  add_interfaces(*verb, options->interfaces);
  verb->add_option("--timeout", options->timeout_s,
                   "seconds for a deployment to be found, and to take it")
      ->capture_default_str()
      ->check(not_positive);
  verb->callback([options, &action] { action = [options] { return stop_arms(*options); }; });
}

void add_inspection(CLI::App& app, Action& action) {
  auto source = std::make_shared<DeploymentSource>();
  auto json = std::make_shared<bool>(false);
  CLI::App* check = app.add_subcommand("check", "Find everything that is wrong in a deployment");
  add_source(*check, *source);
  check->add_flag("--json", *json, "as JSON: what is wrong, each with its place");
  check->callback([=, &action] { action = [=] { return check_deployment(*source, *json); }; });

  CLI::App* show =
      app.add_subcommand("show", "Print the resolved file with the origin of every value");
  add_source(*show, *source);
  show->add_flag("--json", *json, "as JSON");
  show->callback([=, &action] { action = [=] { return show_deployment(*source, *json); }; });

  auto dot = std::make_shared<bool>(false);
  CLI::App* graph = app.add_subcommand("graph", "Print who writes and who reads every topic");
  add_source(*graph, *source);
  graph->add_flag("--dot", *dot, "as Graphviz");
  graph->add_flag("--json", *json, "as JSON");
  graph->callback(
      [=, &action] { action = [=] { return graph_deployment(*source, *dot, *json); }; });
}

void add_schema(CLI::App& app, Action& action) {
  CLI::App* schema = app.add_subcommand(
      "schema", "JSON Schema of deployments, for editors: armature schema > armature.schema.json");
  schema->callback([&action] { action = [] { return print_schema(); }; });
}

void add_arm(CLI::App* verb, ArmChoice& arm) {
  verb->add_option("--robot", arm.robot, "robot file, or URDF file (*.urdf) with --tip");
  verb->add_option("--tip", arm.tip,
                   "frame that goals are stated for, instead of 'tool'; of a URDF file a link");
  verb->add_option("--base", arm.base, "link of a URDF file that is the base (its root)");
}

void add_verify(CLI::App& plugin, Action& action) {
  auto options = std::make_shared<VerifyOptions>();
  CLI::App* verify = plugin.add_subcommand("verify", "Check every law of the plugin's kind");
  verify->add_option("plugin", options->plugin, "its id, or a library file")->required();
  add_arm(verify, options->arm);
  verify->add_option("--params", options->params, "the plugin's parameters, a YAML map");
  verify->add_option("--rig", options->rig, "rig file, for a component that uses one");
  verify->add_option("--poses", options->poses, "of every set; of a component its activations")
      ->capture_default_str()
      ->check(CLI::Range(1, 1000000));
  verify->add_option("--seed", options->seed, "of the random numbers")
      ->capture_default_str()
      ->check(wrong_seed);
  verify
      ->add_option("--timeout", options->timeout_s,
                   "seconds that a law may take; a solver that hangs breaks it")
      ->capture_default_str()
      ->check(wrong_number)
      ->check(CLI::Range(0.1, 1e6));
  verify->add_flag("--json", options->json, "as JSON");
  verify->callback([options, &action] { action = [options] { return verify_plugin(*options); }; });
}

void add_plugin_verbs(CLI::App& app, Action& action) {
  CLI::App* plugin = app.add_subcommand("plugin", "List, describe, start and verify plugins");
  plugin->require_subcommand(1);
  auto json = std::make_shared<bool>(false);
  auto id = std::make_shared<std::string>();
  auto directory = std::make_shared<std::string>();

  CLI::App* list = plugin->add_subcommand("list", "Every plugin that is found");
  list->add_flag("--json", *json, "as JSON");
  list->callback([=, &action] { action = [=] { return list_plugins(*json); }; });

  CLI::App* info = plugin->add_subcommand("info", "What one plugin takes and gives");
  info->add_option("id", *id, "e.g. ik/numeric")->required();
  info->add_flag("--json", *json, "as JSON");
  info->callback([=, &action] { action = [=] { return show_plugin(*id, *json); }; });

  CLI::App* fresh = plugin->add_subcommand("new", "Write a complete small plugin to start from");
  fresh->add_option("id", *id, "ik/mine: a solver; arm/mine: the driver of an arm")->required();
  fresh->add_option("-o,--output", *directory, "folder to write it into")->required();
  fresh->callback([=, &action] { action = [=] { return new_plugin(*id, *directory); }; });

  add_verify(*plugin, action);
}

void add_topic_verbs(CLI::App& app, Action& action) {
  constexpr int kMaxSamples = std::numeric_limits<int>::max();
  CLI::App* topic = app.add_subcommand("topic", "Watch a running deployment over DDS");
  topic->require_subcommand(1);
  auto options = std::make_shared<TopicOptions>();
  const auto add_common = [&](CLI::App* verb) {
    verb->add_option("--domain", options->domain, "DDS domain")->check(CLI::Range(0, 232));
    add_interfaces(*verb, options->interfaces);
    verb->add_option("--timeout", options->timeout_s, "give up after this many seconds")
        ->check(not_positive);
    verb->add_flag("--json", options->json, "as JSON");
  };
  CLI::App* list = topic->add_subcommand("list", "Topics, types, and how many write and read them");
  add_common(list);
  list->callback([=, &action] { action = [=] { return list_topics(*options); }; });

  CLI::App* echo = topic->add_subcommand("echo", "Print the samples of a topic");
  echo->add_option("topic", options->topic, "e.g. /dental_lamp/arm/measured_js")->required();
  echo->add_option("-n,--count", options->count, "end after this many samples")
      ->check(CLI::Range(1, kMaxSamples));
  echo->add_flag("--full", options->full, "long byte arrays in full");
  add_common(echo);
  echo->callback([=, &action] { action = [=] { return echo_topic(*options); }; });

  CLI::App* hz = topic->add_subcommand("hz", "How often a topic is written");
  hz->add_option("topic", options->topic, "e.g. /dental_lamp/arm/measured_js")->required();
  hz->add_option("-n,--count", options->count, "end after this many samples, at least 2")
      ->check(CLI::Range(2, kMaxSamples));
  add_common(hz);
  hz->callback([=, &action] { action = [=] { return topic_rate(*options); }; });
}

void add_calculators(CLI::App& app, Action& action) {
  auto arm = std::make_shared<ArmChoice>();
  auto solver = std::make_shared<SolverChoice>();
  auto input = std::make_shared<std::string>();

  CLI::App* fk = app.add_subcommand("fk", "Forward kinematics: JSON lines in, JSON lines out");
  add_arm(fk, *arm);
  fk->get_option("--robot")->required();
  fk->add_option("input", *input, "file of JSON lines (standard input)");
  fk->callback([=, &action] { action = [=] { return run_fk(*arm, *input); }; });

  CLI::App* ik = app.add_subcommand("ik", "Inverse kinematics: JSON lines in, JSON lines out");
  add_arm(ik, *arm);
  ik->get_option("--robot")->required();
  ik->add_option("--plugin", solver->plugin, "solver")->capture_default_str();
  ik->add_option("--params", solver->params, "its parameters, a YAML map: '{max_restarts: 3}'");
  ik->add_option("input", *input, "file of JSON lines (standard input)");
  ik->callback([=, &action] { action = [=] { return run_ik(*arm, *solver, *input); }; });
}

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
  plan->add_option("--motions", options->motions, "of each shape")
      ->capture_default_str()
      ->check(CLI::Range(1, 1000000));
  plan->add_option("--keys", options->keys, "of an orientation curve")
      ->capture_default_str()
      ->check(CLI::Range(2, 1000));
  plan->add_option("--seed", options->seed, "of the random numbers")
      ->capture_default_str()
      ->check(wrong_seed);
  plan->add_option("--repetitions", options->repetitions, "of every plan")
      ->capture_default_str()
      ->check(CLI::Range(1, 1000));
  plan->add_flag("--json", options->json, "as JSON");
  plan->callback([options, &action] { action = [options] { return bench_plan(*options); }; });
}

void add_bench_loop(CLI::App* bench, Action& action) {
  auto options = std::make_shared<LoopBenchOptions>();
  CLI::App* loop = bench->add_subcommand(
      "loop", "How late an executor's steps begin, beside a bare thread: armature bench loop");
  loop->add_option("--readers", options->readers, "other processes that read, in further rounds")
      ->check(CLI::Range(0, 32));
  loop->add_option("--rounds", options->rounds, "of each comparison")
      ->capture_default_str()
      ->check(CLI::Range(1, 1000));
  loop->add_option("--seconds", options->seconds, "of a round: at least 1000 periods")
      ->capture_default_str()
      ->check(wrong_number)
      ->check(CLI::Range(0.1, 3600.0));
  loop->add_option("--period", options->period_s, "of the loops [s]")
      ->capture_default_str()
      ->check(wrong_number)
      ->check(CLI::Range(1e-4, 0.1));
  loop->add_option("--priority", options->priority, "of the loops, SCHED_FIFO; 0: normal")
      ->capture_default_str()
      ->check(CLI::Range(0, 99));
  loop->add_option("--domain", options->domain, "DDS domain")
      ->capture_default_str()
      ->check(CLI::Range(0, 232));
  loop->add_flag("--json", options->json, "as JSON");
  loop->callback([options, &action] {
    if (std::string wrong = wrong_round(*options); !wrong.empty()) {
      throw CLI::ValidationError("--seconds", wrong);
    }
    action = [options] { return bench_loop(*options); };
  });
}

void add_bench(CLI::App& app, Action& action) {
  CLI::App* bench = app.add_subcommand("bench", "Measure plugins side by side");
  bench->require_subcommand(1);
  add_bench_plan(bench, action);
  add_bench_loop(bench, action);
  auto options = std::make_shared<BenchOptions>();
  CLI::App* ik = bench->add_subcommand(
      "ik", "Solvers on the same goals: armature bench ik --robot configs/robots/dental_lamp.yaml");
  add_arm(ik, options->arm);
  ik->get_option("--robot")->required();
  ik->add_option("--plugins", options->plugins, "solvers, 'ik/lamp_geometric,ik/numeric' (all)")
      ->delimiter(',');
  ik->add_option("--params", options->params, "YAML: '{ik/numeric: {max_restarts: 3}}'");
  ik->add_option("--poses", options->poses, "goals")
      ->capture_default_str()
      ->check(CLI::Range(1, 10000000));
  ik->add_option("--seed", options->seed, "of the random numbers")
      ->capture_default_str()
      ->check(wrong_seed);
  ik->add_flag("--near", options->near_only, "only seeds within 5 degrees of a solution");
  ik->add_option("--repetitions", options->repetitions, "of every solve")
      ->capture_default_str()
      ->check(CLI::Range(1, 1000));
  ik->add_option("--tolerance", options->tolerance, "of a residual, m and rad")
      ->capture_default_str()
      ->check(not_positive);
  ik->add_option("--baseline", options->baseline,
                 "what the others are compared with (ik/kdl if it is among them, else the first)");
  ik->add_option("--out", options->out, "folder for solves.csv, cumulative.svg, summary.json");
  ik->add_flag("--json", options->json, "as JSON");
  ik->callback([options, &action] { action = [options] { return bench_ik(*options); }; });
}

void add_calibrations(CLI::App& app, Action& action) {
  CLI::App* calibrate =
      app.add_subcommand("calibrate", "Where a tool or a tracker is, from recorded poses");
  calibrate->require_subcommand(1);
  auto options = std::make_shared<CalibrationOptions>();
  const auto add = [&](const char* name, const char* what, int (*run)(const CalibrationOptions&)) {
    CLI::App* verb = calibrate->add_subcommand(name, what);
    verb->add_option("poses", options->poses, "file of recorded poses: JSON lines, or YAML")
        ->required();
    add_arm(verb, options->arm);
    verb->get_option("--tip")->description("frame that is the flange (flange)");
    verb->add_option("-o,--output", options->output, "YAML file to write (-, standard output)");
    verb->add_option("--tracker", options->tracker, "name of its frame")->capture_default_str();
    verb->add_option("--body", options->body, "name of its frame")->capture_default_str();
    verb->add_flag("--json", options->json, "as JSON");
    verb->callback([=, &action] { action = [=] { return run(*options); }; });
    return verb;
  };
  CLI::App* hand_eye = add("hand-eye",
                           "A tracker and a body on the flange: armature calibrate hand-eye "
                           "poses.jsonl --robot configs/robots/med7.yaml -o hand_eye.yaml",
                           run_hand_eye_calibration);
  hand_eye->add_option("--noise", options->noise, "of the tracker's poses, mm and deg per axis")
      ->expected(2)
      ->allow_extra_args(false);
  hand_eye->add_option("--at", options->at_m, "point of the base [m] whose error is told")
      ->expected(3)
      ->allow_extra_args(false);
  CLI::App* tool = add("tool",
                       "The tip of a tool that was turned about it: armature calibrate tool "
                       "poses.jsonl -o tool.yaml",
                       run_tool_calibration);
  tool->add_option("--tool", options->tool, "name of its frame")->capture_default_str();
}

void add_doctor(CLI::App& app, Action& action) {
  auto json = std::make_shared<bool>(false);
  CLI::App* doctor =
      app.add_subcommand("doctor", "What this machine lacks for a deployment, with the way out");
  doctor->add_flag("--json", *json, "as JSON");
  doctor->callback([=, &action] { action = [=] { return examine_machine(*json); }; });
}

/// What shells and man(1) want to know of all the verbs.
void add_words(CLI::App& app, Action& action) {
  auto shell = std::make_shared<std::string>();
  CLI::App* completion = app.add_subcommand(
      "completion", "Print what completes a line: eval \"$(armature completion bash)\"");
  completion->add_option("shell", *shell, "whose script")
      ->required()
      ->check(CLI::IsMember(std::vector<std::string>{"bash", "zsh", "fish"}));
  completion->callback([=, &action] { action = [=] { return print_completion(*shell); }; });

  CLI::App* man = app.add_subcommand("man", "Print this help as a manual page (roff)");
  man->callback([&app, &action] {
    action = [&app] {
      fmt::print("{}", man_page(verb_tree(app), ARMATURE_VERSION));
      return kOk;
    };
  });
}

/// What is wrong with the verbs at the beginning of the line; empty: nothing.
std::string unknown_verb(const CLI::App& app, const std::vector<std::string>& line) {
  const CLI::App* verb = &app;
  for (const std::string& word : line) {
    if (verb->get_require_subcommand_min() == 0 || word.starts_with('-')) return "";
    const CLI::App* next = nullptr;
    std::vector<std::string> names;
    for (const CLI::App* known : verb->get_subcommands(nullptr)) {
      if (known->get_name() == word) next = known;
      names.push_back(known->get_name());
    }
    if (!next) {
      return fmt::format("'{}' has no verb {}{}", verb->get_name(), config::in_quotes(word),
                         config::did_you_mean(word, names));
    }
    verb = next;
  }
  return "";
}

/// The words of a command line, "help run" as "run --help".
std::vector<std::string> words_of(int argc, char** argv) {
  std::vector<std::string> words(argv + 1, argv + argc);
  if (words.empty() || words.front() != "help") return words;
  words.erase(words.begin());
  words.push_back("--help");
  return words;
}

int run_command_line(int argc, char** argv) {
  CLI::App app{
      "Config-driven robot systems over DDS.\n\n"
      "Example: armature run configs/dental_lamp.yaml --set "
      "components.motion.ik.plugin=ik/numeric"};
  app.name("armature");
  app.require_subcommand(1);
  app.set_version_flag("--version", "armature " ARMATURE_VERSION, "Print the version");
  app.add_subcommand("help", "What a verb does, and its options: armature help run");
  Action action;
  add_run(app, action);
  add_drill(app, action);
  add_stop(app, action);
  add_inspection(app, action);
  add_schema(app, action);
  add_plugin_verbs(app, action);
  add_topic_verbs(app, action);
  add_calculators(app, action);
  add_calibrations(app, action);
  add_bench(app, action);
  add_doctor(app, action);
  add_words(app, action);
  std::vector<std::string> words = words_of(argc, argv);
  if (!words.empty() && words.front() == "__complete") {
    return exit_code_of([&] {
      return print_candidates(verb_tree(app), {words.begin() + 1, words.end()});
    });
  }
  if (const std::string wrong = unknown_verb(app, words); !wrong.empty()) {
    fmt::print(stderr, "{}\n", wrong);
    return kUsage;
  }
  std::ranges::reverse(words);  // as CLI11 wants them
  try {
    app.parse(words);
  } catch (const CLI::ParseError& error) {
    return app.exit(error) == 0 ? kOk : kUsage;
  } catch (const InvalidChoice& error) {
    fmt::print(stderr, "{}\n", error.what());
    return exit_code_of(error);
  }
  return exit_code_of(action);
}

}  // namespace
}  // namespace armature

/// Standard streams that the caller has closed: else the next files that are opened would be them.
/// What is written to one of them then fails.
void hold_standard_streams() {
  int file = 0;
  do {
    file = open("/dev/null", O_RDONLY);
  } while (file >= 0 && file <= STDERR_FILENO);
  if (file > STDERR_FILENO) close(file);
}

int main(int argc, char** argv) {
  hold_standard_streams();
  std::ios::sync_with_stdio(false);
  return armature::run_command_line(argc, argv);
}
