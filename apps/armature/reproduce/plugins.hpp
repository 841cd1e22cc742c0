// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <map>
#include <memory>
#include <stdexcept>
#include <string>
#include <utility>

#include "armature/config/params.hpp"
#include "armature/robot/model/robot_model.hpp"
#include "armature/runtime/plugins/plugin_registry.hpp"
#include "armature/values/expected.hpp"

namespace armature::reproduce {

/// What was asked for, or a std::runtime_error that says who refused it and why.
template <class T>
T or_throw(Expected<T> given, const std::string& who) {
  if (!given) throw std::runtime_error(who + ": " + given.error().text);
  return std::move(*given);
}

/// The shipped robot `name`, "master".
RobotModel shipped_robot(const std::string& name);

/// Plugins as they are deployed, with the defaults of their parameters or with what a YAML map
/// says. Each is made once and kept as long as this.
class Plugins {
 public:
  /// `args`: what the kind's factory takes before the parameters; the same at every call. Throws
  /// std::runtime_error with the plugin's own refusal.
  template <class Kind, class... Args>
  const Kind& get(const std::string& id, const std::string& params, const Args&... args) {
    std::shared_ptr<void>& kept = made_[id + ' ' + params];
    if (!kept) {
      auto plugin = registry_.make<Kind>(id, args..., params_for(id, params));
      if (!plugin) throw std::runtime_error(id + ": " + plugin.error().text);
      kept = std::make_shared<PluginPtr<Kind>>(std::move(*plugin));
    }
    return **static_cast<PluginPtr<Kind>*>(kept.get());
  }

 private:
  Params params_for(const std::string& id, const std::string& params) const;

  PluginRegistry registry_;
  std::map<std::string, std::shared_ptr<void>> made_;  // by id and parameters
};

}  // namespace armature::reproduce
