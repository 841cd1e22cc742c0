// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "armature/runtime/deployment_file/deployment_config.hpp"

namespace armature ARMATURE_EXPORT {

/// Tries the libraries of the components of `process` and of their slots together, before they are
/// loaded one by one; of all components where `process` is empty. See plugin_trial.hpp.
void try_together(const DeploymentConfig& deployment, const std::string& process);

}  // namespace armature
