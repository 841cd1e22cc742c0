// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "armature/runtime/deployment_file/deployment_config.hpp"

namespace armature {

/// Two components that must mean the same by a parameter (what is asked for, and what it is judged
/// against, or kept by who executes it) say so once: `same_as` in plugin.yaml, of components that
/// exchange topics. What was not written is taken from the other one; what was written and differs
/// is a problem at its line. So is what is above a parameter of who reads an output, where
/// `at_most` says that it must not be.
void link_parameters(DeploymentConfig& deployment, config::Problems& problems);

}  // namespace armature
