// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "drill/arm_record.hpp"
#include "drill/drilled_deployment.hpp"

namespace armature::drill {

/// What the samples of all arms say of a run that is over.
struct Verdict {
  std::string arm;    // what they did: "ramped to rest in 0.31 s"
  double rest_s = 0;  // until the last one rested
  std::string wrong;  // the first thing that must not be, with arm, joint and value; empty: nothing
};

/// Judges the arms of a run that was to come to rest from `stop` on. `lost` is an arm whose driver
/// was taken away, which says nothing of how it ends.
Verdict judge(const std::vector<DrilledArm>& arms, const std::vector<ArmRecord>& records,
              Arrival stop, const std::string& lost);

}  // namespace armature::drill
