// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string_view>

#include "needle_task.hpp"

namespace armature {

/// By how much the wrist is out of reach [m], and why.
struct ReachMiss {
  double shortfall = 0;
  std::string_view detail;
};

/// That of the wrist at `wrist` (seen from the shoulder frame), 0 where it is reached:
/// FourArms::shortfall without an arm being worked out.
ReachMiss miss_at(const ArmNumbers& arm, const Triple& wrist);

/// Where it is sure that no depth brings the wrist within reach, what is missing at the best one;
/// none where some depth may. Without it two searches over the depth would find out the same.
/// Real-time safe.
std::optional<ReachMiss> line_out_of_reach(const NeedleTask& task);

}  // namespace armature
