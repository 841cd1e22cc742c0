// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>

#include "arm_choice.hpp"
#include "armature/bus/network.hpp"
#include "armature/web/monitor_server.hpp"
#include "run/run.hpp"
#include "watch/outsider.hpp"

namespace CLI {
class App;
}

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

}  // namespace armature
