// SPDX-License-Identifier: Apache-2.0
#include "run/other_processes.hpp"

#include <fmt/format.h>

#include <memory>
#include <utility>

#include "armature/runtime/deployment_file/on_fault.hpp"
#include "armature/runtime/hosts/host_link.hpp"

namespace armature {
namespace {

OnFault on_loss(const std::string& process, const DeploymentConfig& config) {
  return stops_run(process, config) ? OnFault::stop : OnFault::isolate;
}

}  // namespace

bool wants_timing(const RunOptions& options, const DeploymentConfig& config) {
  return options.timing || config.record;
}

std::vector<std::string> process_arguments(const RunOptions& options, int domain,
                                           const std::string& process,
                                           const RunOptions::Origin& origin) {
  std::vector<std::string> arguments{"run",
                                     "--process",
                                     process,
                                     "--domain",
                                     std::to_string(domain),
                                     "--clock-offset-ns",
                                     std::to_string(origin.clock_offset.count()),
                                     "--clock-start-ns",
                                     std::to_string(origin.start.ns),
                                     "--run-id",
                                     origin.run};
  if (options.report) arguments.insert(arguments.end(), {"--report-files", *options.report});
  if (options.timing) arguments.push_back("--timing");
  if (options.keep_running) arguments.push_back("--keep-running");
  if (options.inject) arguments.insert(arguments.end(), {"--inject", *options.inject});
  for (const auto& assignment : options.source.assignments) {
    arguments.insert(arguments.end(), {"--set", assignment});
  }
  for (const auto& file : options.source.files) arguments.push_back(file.string());
  return arguments;
}

void start_processes(ChildProcesses& children, const RunOptions& options,
                     const DeploymentConfig& config, int domain, const RunOptions::Origin& origin) {
  RunOptions theirs = options;
  theirs.timing = wants_timing(options, config);
  for (const std::string& process : config.processes()) {
    if (process == kMainProcess || config.host_of(process) != kMainHost) continue;
    children.start(process, process_arguments(theirs, domain, process, origin),
                   on_loss(process, config));
  }
}

void expect_hosts(ChildProcesses& children, const RunOptions& options, Deployment& deployment,
                  const RunOptions::Origin& origin) {
  const DeploymentConfig& config = deployment.config();
  for (const std::string& host : config.hosts()) {
    if (host == kMainHost) continue;
    const HostLinkEnd end{
        .deployment = config.name, .host = host, .of_main = true, .id = origin.run};
    ChildProcesses::Host expected{
        .link = std::make_unique<HostLink>(deployment.transport(), end, deployment.clock()),
        .processes = {},
        .fingerprint = config.fingerprint,
        .welcome = fmt::format("run {} {} {:d} {:d}", origin.run, origin.start.ns,
                               wants_timing(options, config), options.keep_running)};
    for (const std::string& process : config.processes()) {
      if (config.host_of(process) != host) continue;
      expected.processes.emplace_back(process, on_loss(process, config));
    }
    children.expect(std::move(expected));
  }
}

}  // namespace armature
