// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string_view>

#include "needle_task.hpp"

namespace armature {

/// A depth for a needle line. `within_limits`: a branch keeps the limits there; `reachable`: a
/// branch reaches; else `shortfall` says by how much [m] the depth that comes nearest does not.
struct ChosenDepth {
  double depth = 0;
  bool within_limits = false, reachable = false;
  double shortfall = 0;
  std::string_view detail;
};

/// Of the depths of NeedleTask::depth_at, the one nearest to `wanted` where a branch keeps the
/// limits; if there is none, one in between where a branch does; else the nearest to `wanted` where
/// a branch reaches. Bounded, no allocation.
ChosenDepth choose_depth(const NeedleTask& task, double wanted);

}  // namespace armature
