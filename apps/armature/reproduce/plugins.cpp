// SPDX-License-Identifier: Apache-2.0
#include "reproduce/plugins.hpp"

#include "arm_choice.hpp"
#include "verbs/shipped_configs.hpp"

namespace armature::reproduce {

RobotModel shipped_robot(const std::string& name) {
  return load_robot_model(shipped_config_folder() / "robots" / (name + ".yaml"));
}

Params Plugins::params_for(const std::string& id, const std::string& params) const {
  const PluginManifest* manifest = registry_.find(id);
  if (!manifest) throw std::runtime_error(registry_.unknown_text(id));
  return params_of(*manifest, params);
}

}  // namespace armature::reproduce
