// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "completion/candidate.hpp"
#include "run/run.hpp"

namespace armature {

/// What the value of --set may become in this deployment: "components.arm." one key on, at the end
/// plugin ids and what a parameter may be. None when the deployment cannot be read.
Candidates assignments(const DeploymentSource& source, const std::string& typed);

}  // namespace armature
