// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <CLI/CLI.hpp>
#include <cstdint>
#include <functional>
#include <string>
#include <type_traits>

#include "arm_choice.hpp"
#include "armature/bus/network.hpp"
#include "armature/web/monitor_server.hpp"
#include "run/run.hpp"
#include "verbs/option_checks.hpp"
#include "watch/outsider.hpp"

namespace armature {

/// What the chosen verb will do, once the whole line has been understood.
using Action = std::function<int()>;

/// Each adds verbs to the command line; the one that is chosen sets `action`, which outlives it.
void add_deployment_verbs(CLI::App& app, Action& action);
void add_plugin_verbs(CLI::App& app, Action& action);
/// Adds the verbs of recordings: record, info.
void add_record_verbs(CLI::App& app, Action& action);
/// Adds those that watch running deployments: topic, top, log, monitor.
void add_watch_verbs(CLI::App& app, Action& action);
void add_arm_verbs(CLI::App& app, Action& action);
void add_bench_verbs(CLI::App& app, Action& action);
void add_paper_verbs(CLI::App& app, Action& action);
/// Of the machine and its shells: doctor, completion, man.
void add_machine_verbs(CLI::App& app, Action& action);

/// Options that several verbs have: which deployment; which arm; how a verb joins DDS that is no
/// part of a deployment, beside its domain.
void add_source(CLI::App& verb, DeploymentSource& source);
void add_arm(CLI::App* verb, ArmChoice& arm);
void add_network(CLI::App& verb, NetworkOptions& network);
/// Where a page is served: --bind, --port, --origin, --token.
void add_monitor_address(CLI::App& verb, MonitorAddress& server);
/// The domain too, --timeout and --json.
void add_watch(CLI::App& verb, WatchOptions& options);
void add_seed(CLI::App* verb, std::uint64_t& seed, const std::string& what);
/// A number that has a default, from `least` to `most`.
template <class Number, class Limit>
void add_ranged(CLI::App* verb, const std::string& name, Number& number, const std::string& what,
                Limit least, Limit most) {
  CLI::Option* option = verb->add_option(name, number, what)->capture_default_str();
  if constexpr (std::is_floating_point_v<Limit>) option->check(wrong_number);
  option->check(CLI::Range(least, most));
}

}  // namespace armature
