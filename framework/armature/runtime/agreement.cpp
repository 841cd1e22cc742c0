// SPDX-License-Identifier: Apache-2.0
#include "armature/runtime/agreement.hpp"

#include <fmt/format.h>

#include "armature/runtime/graph.hpp"

namespace armature {

void agree_on_params(DeploymentConfig& deployment, config::Problems& problems) {
  for (ComponentConfig& component : deployment.components) {
    for (const ParamSpec& spec : component.manifest->params) {
      for (const ComponentConfig& other : deployment.components) {
        if (spec.same_as != other.plugin_id || !exchange_topics(component, other)) continue;
        if (component.params.agree(spec.name, other.params)) continue;
        problems.add(component.params.origin(spec.name),
                     fmt::format("'{}' of component '{}' must be the same as that of component "
                                 "'{}', and is not; leave one of them out, or make them equal",
                                 spec.name, component.name, other.name));
      }
    }
  }
}

}  // namespace armature
