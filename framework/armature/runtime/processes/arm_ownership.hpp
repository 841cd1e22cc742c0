// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "armature/runtime/deployment_file/deployment_config.hpp"
#include "armature/runtime/processes/instance_lock.hpp"

namespace armature ARMATURE_EXPORT {

/// Makes `process` of the deployment the owner of what it drives, for as long as the locks are
/// held. Every process owns its name in the deployment on its domain, which is what simulated arms
/// are known by, and who commands an arm; a process that drives metal owns each driver's device,
/// too, or, where the driver names none, the only arm of that plugin. The main process also looks
/// whether the devices of the others are free. Throws std::runtime_error with the owner's pid and
/// the way out when another process owns one.
std::vector<InstanceLock> own_arms(const DeploymentConfig& deployment, const std::string& process,
                                   int domain);

}  // namespace armature
