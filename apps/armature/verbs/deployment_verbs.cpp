// SPDX-License-Identifier: Apache-2.0
#include <CLI/CLI.hpp>
#include <memory>
#include <stdexcept>
#include <string>
#include <vector>

#include "drill/drill.hpp"
#include "inspect/check.hpp"
#include "inspect/inspect.hpp"
#include "operator/operator.hpp"
#include "run/run.hpp"
#include "run/stop.hpp"
#include "schema/schema.hpp"
#include "sweep/sweep.hpp"
#include "verbs/option_checks.hpp"
#include "verbs/verbs.hpp"
#include "watch/live_graph.hpp"

namespace armature {
namespace {

/// What the main process of a deployment tells the others that it starts, and a drill the run that
/// it drills; nobody types it.
void add_handed_over(CLI::App& verb, RunOptions& options) {
  const auto origin = [&options]() -> RunOptions::Origin& {
    if (!options.origin) options.origin.emplace();
    return *options.origin;
  };
  verb.add_option("--control", options.control)->group("");
  verb.add_option("--inject", options.inject)->group("");
  verb.add_option("--report-files", options.report_files)->group("");
  verb.add_option_function<std::int64_t>(
          "--clock-offset-ns", [origin](std::int64_t ns) { origin().clock_offset = Duration{ns}; })
      ->group("");
  verb.add_option_function<std::string>("--run-id",
                                        [origin](const std::string& run) { origin().run = run; })
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
  CLI::Option* process =
      verb->add_option("--process", options->process, "run only this process of the deployment");
  verb->add_option("--host", options->host,
                   "run the processes of this host, of a deployment that names several (main)")
      ->excludes(process);
  verb->add_flag("--json", options->json, "print the result as one JSON object");
  verb->add_flag("--timing", options->timing, "tell how late and how long every step was");
  verb->add_flag("--keep-running", options->keep_running,
                 "go on when the scenario is over, until Ctrl-C: to watch it");
  verb->add_option("--report", options->report,
                   "write report.json, the page report.html, tables and pictures into this folder")
      ->check(no_name)
      ->excludes(process);
  add_handed_over(*verb, *options);
  verb->callback([options, &action] { action = [options] { return run_deployment(*options); }; });
}

void add_drill(CLI::App& app, Action& action) {
  auto options = std::make_shared<DrillOptions>();
  CLI::App* verb = app.add_subcommand(
      "drill", "Pull the plugs of a deployment whose arms are simulated, while they move");
  add_source(*verb, options->source);
  add_ranged(verb, "--moments", options->moments, "at which each fault is fired", 1, 1000);
  add_ranged(verb, "--within", options->within_s,
             "the moments lie in so many seconds after an arm was first seen to move", 0.0, 100.0);
  verb->add_option("--seed", options->seed, "of the moments (another one every time)")
      ->check(wrong_seed);
  verb->add_option("--faults", options->faults, "only these, 'interrupt,motion_killed' (all)")
      ->delimiter(',');
  add_ranged(verb, "--jobs", options->jobs, "runs at the same time", 1, 16);
  verb->add_option("--domain", options->domain,
                   "DDS domain of all runs, which are then one at a time (any that is free)")
      ->check(CLI::Range(0, 232));
  verb->add_flag("--short", options->brief, "a random choice of faults, half a minute");
  verb->add_flag("--json", options->json, "as JSON");
  verb->callback([options, &action] { action = [options] { return run_drill(*options); }; });
}

/// What is wrong with an option's value is told as it is thrown.
template <class Read>
CLI::Validator reading(Read read) {
  return {[read](std::string& given) -> std::string {
            try {
              read(given);
              return "";
            } catch (const std::invalid_argument& error) {
              return error.what();
            }
          },
          ""};
}

void add_sweep(CLI::App& app, Action& action) {
  auto options = std::make_shared<SweepOptions>();
  auto seeds = std::make_shared<std::string>("1..100");
  auto vary = std::make_shared<std::vector<std::string>>();
  CLI::App* verb = app.add_subcommand(
      "sweep",
      "Run a deployment for many seeds in lockstep and tell the spread of its figures: "
      "armature sweep sr1_biopsy --seeds 1..200 --out sweep");
  add_source(*verb, options->source);
  verb->get_option("--set")->check(reading(sweep::check_assignment));
  verb->add_option("--seeds", *seeds, "1..200, or 1,2,5..9")
      ->capture_default_str()
      ->check(reading(sweep::seeds_of));
  verb->add_option("--vary", *vary,
                   "values of a key: components.motion.ik.plugin=ik/numeric,ik/kdl; several: every "
                   "combination")
      ->allow_extra_args(false)
      ->check(reading(sweep::vary_of));
  verb->add_flag("--pool", options->pool, "one table of all combinations together");
  verb->add_option("--jobs", options->jobs, "runs at the same time (as many as processors)")
      ->check(CLI::Range(1, 256));
  verb->add_option("--timeout", options->timeout_s, "seconds that one run may take")
      ->capture_default_str()
      ->check(not_positive);
  verb->add_option("--out", options->out,
                   "folder for figures.csv, histograms and the reports of all runs; with the same "
                   "folder an interrupted sweep goes on")
      ->check(no_name);
  verb->add_flag("--json", options->json, "as JSON");
  verb->callback([options, seeds, vary, &action] {
    options->seeds = sweep::seeds_of(*seeds);
    for (const std::string& one : *vary) options->vary.push_back(sweep::vary_of(one));
    try {
      sweep::combinations(options->vary);
    } catch (const std::invalid_argument& error) {
      throw CLI::ValidationError("--vary", error.what());
    }
    action = [options] { return sweep_deployment(*options); };
  });
}

void add_stop(CLI::App& app, Action& action) {
  auto options = std::make_shared<StopOptions>();
  CLI::App* verb = app.add_subcommand(
      "stop", "Stop every arm of a DDS domain: they stay stopped until they are rearmed");
  add_ranged(verb, "--domain", options->network.domain, "DDS domain", 0, 232);
  add_network(*verb, options->network);
  verb->add_option("--timeout", options->timeout_s,
                   "seconds for a deployment to be found, and to take it")
      ->capture_default_str()
      ->check(not_positive);
  verb->callback([options, &action] { action = [options] { return stop_arms(*options); }; });
}

void add_operator(CLI::App& app, Action& action) {
  auto options = std::make_shared<OperatorOptions>();
  CLI::App* verb = app.add_subcommand(
      "operator",
      "Show the steps of a running deployment's task; confirm, pause, resume, go back, abort");
  add_source(*verb, options->source);
  verb->add_option("--say", options->say, "one word, and end: confirm, pause, resume, back, abort")
      ->check(CLI::IsMember({"confirm", "pause", "resume", "back", "abort"}));
  verb->add_option("--step", options->step,
                   "which step --say confirm means; needed where a task asks about several")
      ->check(no_text);
  verb->add_option("--component", options->component, "the task, where there are several");
  verb->add_option("--domain", options->domain, "DDS domain, instead of the file's")
      ->check(CLI::Range(0, 232));
  add_network(*verb, options->network);
  verb->add_option("--timeout", options->timeout_s,
                   "seconds for the task to be found, and to answer")
      ->capture_default_str()
      ->check(not_positive);
  verb->add_flag("--json", options->json, "as JSON: a line for every change");
  verb->callback([options, &action] {
    if (!options->step.empty() && options->say != "confirm") {
      throw CLI::ValidationError("--step", "it belongs to --say confirm");
    }
    action = [options] { return be_operator(*options); };
  });
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
}

void add_graph(CLI::App& app, Action& action) {
  struct Options {
    DeploymentSource source;
    WatchOptions watch;
    std::string name;
    bool dot = false, mermaid = false;
  };
  auto options = std::make_shared<Options>();
  CLI::App* verb =
      app.add_subcommand("graph",
                         "Print who writes and who reads every topic, of a file or of what runs: "
                         "armature graph --live");
  add_source(*verb, options->source);
  CLI::Option* files = verb->get_option("files")->required(false);
  CLI::Option* live =
      verb->add_option("--live", options->name,
                       "as a running deployment tells it; its name, where several run")
          ->expected(0, 1)
          ->excludes(files);
  verb->add_option("--domain", options->watch.network.domain, "DDS domain, with --live")
      ->check(CLI::Range(0, 232));
  add_network(*verb, options->watch.network);
  verb->add_option("--timeout", options->watch.timeout_s,
                   "with --live: give up after this many seconds")
      ->check(not_positive);
  live->excludes("--set");
  for (const char* option : {"--domain", "--interface", "--peer", "--discovery-server",
                             "--no-shared-memory", "--timeout"}) {
    verb->get_option(option)->needs(live);
  }
  CLI::Option* dot = verb->add_flag("--dot", options->dot, "for Graphviz");
  CLI::Option* mermaid = verb->add_flag("--mermaid", options->mermaid, "for Mermaid");
  CLI::Option* json = verb->add_flag("--json", options->watch.json, "as JSON");
  mermaid->excludes(dot)->excludes(json);
  dot->excludes(json);
  verb->callback([options, live, &action] {
    const GraphFormat format = options->dot          ? GraphFormat::dot
                               : options->mermaid    ? GraphFormat::mermaid
                               : options->watch.json ? GraphFormat::json
                                                     : GraphFormat::text;
    if (live->count() > 0) {
      action = [=] { return draw_live_graph(options->watch, options->name, format); };
      return;
    }
    if (options->source.files.empty()) throw CLI::RequiredError("files, or --live,");
    action = [=] { return graph_deployment(options->source, format); };
  });
}

void add_schema(CLI::App& app, Action& action) {
  CLI::App* schema = app.add_subcommand(
      "schema", "JSON Schema of files, for editors: armature schema > armature.schema.json");
  auto of = std::make_shared<std::string>("deployment");
  schema->add_option("of", *of, "deployment, robot or rig")
      ->check(CLI::IsMember({"deployment", "robot", "rig"}))
      ->capture_default_str();
  schema->callback([&action, of] { action = [of] { return print_schema(*of); }; });
}

}  // namespace

void add_deployment_verbs(CLI::App& app, Action& action) {
  add_run(app, action);
  add_drill(app, action);
  add_sweep(app, action);
  add_stop(app, action);
  add_operator(app, action);
  add_inspection(app, action);
  add_graph(app, action);
  add_schema(app, action);
}

}  // namespace armature
