// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "armature/runtime/plugins/plugin_registry.hpp"
#include "drill/arm_record.hpp"
#include "drill/drilled_deployment.hpp"

namespace armature::drill {

/// Writes all inputs of the deployment from outside of it for `duration`, fifty times a second:
/// joint states with every joint half a radian (or metre) off where the arm is, everything else as
/// it is made. `records` tell where the arms are. Throws PluginError when the domain cannot be
/// joined.
void write_as_stranger(PluginRegistry& plugins, const DrilledDeployment& deployment, int domain,
                       const std::vector<ArmRecord>& records, Duration duration);

}  // namespace armature::drill
