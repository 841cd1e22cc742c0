// SPDX-License-Identifier: Apache-2.0
#include "run/named_deployment.hpp"

#include "armature/config/document.hpp"
#include "armature/config/problems.hpp"
#include "armature/config/source_text.hpp"

namespace armature {

DeploymentConfig read_named(const DeploymentSource& source, const PluginRegistry& plugins,
                            std::vector<std::string>* notes) {
  const config::PipeTimeLimit one_for_all;
  config::Problems problems;
  auto config = read_deployment(config::load_with_overlays(source.files, source.assignments, notes),
                                plugins, problems);
  problems.throw_if_any();
  return config;
}

}  // namespace armature
