// SPDX-License-Identifier: Apache-2.0
#include "sweep/lockstep_run.hpp"

#include <utility>

#include "armature/runtime/deployment/deployment.hpp"
#include "armature/runtime/plugins/running_component.hpp"
#include "armature/runtime/reporting/run_report.hpp"
#include "run/named_deployment.hpp"

namespace armature {

DeploymentConfig read_for_lockstep(const DeploymentSource& source, const PluginRegistry& plugins) {
  DeploymentSource in_lockstep = source;
  in_lockstep.assignments.push_back("clock=simulated");
  return read_named(in_lockstep, plugins);
}

std::string lockstep_report(DeploymentConfig config, PluginRegistry& plugins) {
  name_crashing_components();
  Deployment deployment{
      std::move(config),
      plugins,
      {.process = "", .on_line = [](const auto&, const auto&) {}, .on_note = [](const auto&) {}}};
  RunWatch alone;
  deployment.run(alone);
  return to_json(RunReport{deployment, {}});
}

}  // namespace armature
