// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "armature/runtime/deployment_file/deployment_config.hpp"

namespace armature {

/// Who waits for whom in a deployment, for how long at most, and what happens then: a table as a
/// comment of YAML, a line for each. What plugins hold (`lease:` and `max_age_s` of their inputs)
/// comes first, in the order of the file; then what the runtime holds between processes, and its
/// watchdog.
std::string leases_comment(const DeploymentConfig& deployment);

}  // namespace armature
