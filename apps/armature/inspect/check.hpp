// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "run/run.hpp"

namespace armature {

/// `armature check`: everything that `run` would do before it starts. With `json` one object on
/// standard output says what is wrong, and nothing is said on standard error; the exit code is the
/// same.
int check_deployment(const DeploymentSource& source, bool json);

}  // namespace armature
