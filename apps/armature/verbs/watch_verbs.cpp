// SPDX-License-Identifier: Apache-2.0
#include <CLI/CLI.hpp>
#include <limits>
#include <memory>

#include "monitor/monitor.hpp"
#include "verbs/option_checks.hpp"
#include "verbs/verbs.hpp"
#include "watch/log.hpp"
#include "watch/top.hpp"
#include "watch/topics.hpp"

namespace armature {
namespace {

constexpr int kMaxSamples = std::numeric_limits<int>::max();

void add_topic(CLI::App& app, Action& action) {
  CLI::App* topic = app.add_subcommand("topic", "Watch a running deployment over DDS");
  topic->require_subcommand(1);
  auto options = std::make_shared<TopicOptions>();
  CLI::App* list = topic->add_subcommand("list", "Topics, types, and how many write and read them");
  add_watch(*list, *options);
  list->callback([=, &action] { action = [=] { return list_topics(*options); }; });

  const auto add_one = [&](const char* name, const char* what) {
    CLI::App* verb = topic->add_subcommand(name, what);
    verb->add_option("topic", options->topic, "e.g. /dental_lamp/arm/measured_js")->required();
    return verb;
  };
  const auto add_samples = [&](CLI::App& verb, int least) {
    verb.add_option(
            "-n,--count", options->count,
            least > 1 ? "end after this many samples, at least 2" : "end after this many samples")
        ->check(CLI::Range(least, kMaxSamples));
    verb.add_flag("--best-effort", options->best_effort,
                  "take samples as they come: one that was lost is not asked for again, and those "
                  "after it do not wait for it");
  };
  CLI::App* info =
      add_one("info", "Who writes and reads a topic, and with which quality of service");
  add_watch(*info, *options);
  info->callback([=, &action] { action = [=] { return describe_topic(*options); }; });

  CLI::App* echo = add_one("echo", "Print the samples of a topic");
  echo->add_flag("--full", options->full, "long byte arrays in full");
  add_samples(*echo, 1);
  add_watch(*echo, *options);
  echo->callback([=, &action] { action = [=] { return echo_topic(*options); }; });

  const auto add_measure = [&](const char* name, const char* what, TopicMeasure measure,
                               int least) {
    CLI::App* verb = add_one(name, what);
    add_samples(*verb, least);
    add_watch(*verb, *options);
    verb->callback([=, &action] { action = [=] { return measure_topic(measure, *options); }; });
  };
  add_measure("hz", "How often a topic is written", TopicMeasure::rate, 2);
  add_measure("bw", "How many bytes a second a topic takes", TopicMeasure::bandwidth, 2);
  add_measure("delay", "How old a topic's samples are when they arrive, by their stamps",
              TopicMeasure::delay, 1);
}

void add_top(CLI::App& app, Action& action) {
  auto options = std::make_shared<TopOptions>();
  CLI::App* verb = app.add_subcommand(
      "top",
      "Show how the components of running deployments are: a live table, with keys as in htop");
  verb->add_option("deployment", options->deployment, "only this one, by its name");
  verb->add_option("-n,--count", options->count, "print this many tables, and end")
      ->check(CLI::Range(1, kMaxSamples));
  verb->add_option("--interval", options->interval_s, "seconds between two tables")
      ->capture_default_str()
      ->check(not_positive);
  add_watch(*verb, *options);
  verb->callback([=, &action] { action = [=] { return watch_components(*options); }; });
}

void add_log(CLI::App& app, Action& action) {
  auto options = std::make_shared<LogOptions>();
  CLI::App* verb =
      app.add_subcommand("log", "Print what running deployments have told lately, as from /rosout");
  verb->add_flag("-f,--follow", options->follow, "and what they tell from now on");
  verb->add_option("--level", options->level, "the least that is shown")
      ->check(CLI::IsMember({"debug", "info", "warning", "error"}))
      ->capture_default_str();
  verb->add_option("--component", options->component, "only what this one says");
  add_watch(*verb, *options);
  verb->callback([=, &action] { action = [=] { return print_log(*options); }; });
}

void add_monitor(CLI::App& app, Action& action) {
  auto options = std::make_shared<MonitorOptions>();
  CLI::App* verb = app.add_subcommand(
      "monitor", "Show running deployments in a browser, and to Foxglove and Lichtblick");
  add_monitor_address(*verb, options->server);
  verb->add_option("--domain", options->network.domain, "DDS domain")->check(CLI::Range(0, 232));
  add_network(*verb, options->network);
  verb->callback([=, &action] { action = [=] { return show_to_browsers(*options); }; });
}

}  // namespace

void add_watch_verbs(CLI::App& app, Action& action) {
  add_topic(app, action);
  add_top(app, action);
  add_log(app, action);
  add_monitor(app, action);
}

}  // namespace armature
