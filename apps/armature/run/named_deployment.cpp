// SPDX-License-Identifier: Apache-2.0
#include "run/named_deployment.hpp"

#include <algorithm>

#include "armature/config/document.hpp"
#include "armature/config/problems.hpp"
#include "armature/config/source_text.hpp"
#include "verbs/shipped_configs.hpp"

namespace armature {

config::Node load_named(const DeploymentSource& source, std::vector<std::string>* notes) {
  std::vector<std::filesystem::path> files;
  for (const auto& given : source.files) files.emplace_back(deployment_file(given));
  return config::load_with_overlays(files, source.assignments, notes);
}

DeploymentConfig read_named(const DeploymentSource& source, const PluginRegistry& plugins,
                            std::vector<std::string>* notes) {
  const config::PipeTimeLimit one_for_all;
  config::Problems problems;
  auto config = read_deployment(load_named(source, notes), plugins, problems);
  problems.throw_if_any();
  return config;
}

std::ptrdiff_t count_components(const DeploymentConfig& deployment) {
  return std::ranges::count(deployment.components, kMainUnit, &ComponentConfig::unit);
}

}  // namespace armature
