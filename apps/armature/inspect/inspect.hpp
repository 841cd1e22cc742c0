// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "inspect/graph_drawing.hpp"
#include "run/run.hpp"

namespace armature {

/// `armature show`: the resolved file, every value with its origin, and as comments whose faults
/// end the run and who waits for whom; with `json` the file alone, as one object.
int show_deployment(const DeploymentSource& source, bool json);
/// `armature graph`: who writes and who reads every topic.
int graph_deployment(const DeploymentSource& source, GraphFormat format);

}  // namespace armature
