// SPDX-License-Identifier: Apache-2.0
#include "reproduce/experiment.hpp"

#include <nlohmann/json.hpp>
#include <stdexcept>

#include "armature/runtime/plugins/plugin_registry.hpp"
#include "isolated.hpp"
#include "sweep/lockstep_run.hpp"
#include "verbs/shipped_configs.hpp"

namespace armature::reproduce {

std::vector<nlohmann::ordered_json> run_experiments(const std::string& name,
                                                    const std::vector<Variation>& variations) {
  constexpr double kTimeout_s = 300;  // of one run
  const auto file = shipped_config_folder() / "experiments" / (name + ".yaml");
  PluginRegistry plugins;
  std::vector<nlohmann::ordered_json> reports(variations.size());
  const auto run = [&](std::size_t i) {
    const DeploymentSource source{.files = {file}, .assignments = variations[i]};
    return lockstep_report(read_for_lockstep(source, plugins), plugins);
  };
  isolated_each(variations.size(), processors(), kTimeout_s, run,
                [&](std::size_t i, const Isolated& outcome) {
                  if (!outcome.fault.empty()) throw std::runtime_error(name + ": " + outcome.fault);
                  reports[i] = nlohmann::ordered_json::parse(outcome.result);
                });
  return reports;
}

nlohmann::ordered_json run_experiment(const std::string& name) {
  return run_experiments(name, {{}}).front();
}

}  // namespace armature::reproduce
