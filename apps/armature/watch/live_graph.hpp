// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "inspect/graph_drawing.hpp"
#include "watch/outsider.hpp"

namespace armature {

/// `armature graph --live`: who writes and who reads every topic, as the running deployment tells
/// it. Without `name` there must be only one in the domain.
int draw_live_graph(const WatchOptions& options, const std::string& name, GraphFormat format);

}  // namespace armature
