// SPDX-License-Identifier: Apache-2.0
#include "reproduce/experiment.hpp"

#include <nlohmann/json.hpp>
#include <stdexcept>

#include "armature/runtime/plugins/plugin_registry.hpp"
#include "isolated.hpp"
#include "sweep/lockstep_run.hpp"
#include "verbs/shipped_configs.hpp"

namespace armature::reproduce {

nlohmann::ordered_json run_experiment(const std::string& name) {
  constexpr double kTimeout_s = 300;
  const DeploymentSource source{
      .files = {shipped_config_folder() / "experiments" / (name + ".yaml")}, .assignments = {}};
  PluginRegistry plugins;
  const Isolated outcome = isolated(
      kTimeout_s, [&] { return lockstep_report(read_for_lockstep(source, plugins), plugins); });
  if (!outcome.fault.empty()) throw std::runtime_error(name + ": " + outcome.fault);
  return nlohmann::ordered_json::parse(outcome.result);
}

}  // namespace armature::reproduce
