// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <map>
#include <stdexcept>
#include <string>

#include "armature/config/params.hpp"
#include "armature/robot/model/robot_model.hpp"
#include "armature/runtime/plugins/plugin_registry.hpp"

namespace armature::reproduce {

/// The shipped robot `name`, "master".
RobotModel shipped_robot(const std::string& name);

/// Plugins as they are deployed, with the defaults of their parameters or with what a YAML map
/// says. Each is made once and kept as long as this.
class Plugins {
 public:
  /// Throws std::runtime_error with the plugin's own refusal.
  template <class Kind, class... Args>
  PluginPtr<Kind> make(const std::string& id, const std::string& params, const Args&... args) {
    auto plugin = registry_.make<Kind>(id, args..., params_for(id, params));
    if (!plugin) throw std::runtime_error(id + ": " + plugin.error().text);
    return std::move(*plugin);
  }

 private:
  Params params_for(const std::string& id, const std::string& params) const;

  PluginRegistry registry_;
};

}  // namespace armature::reproduce
