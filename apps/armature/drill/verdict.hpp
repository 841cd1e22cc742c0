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

/// What was asked of the arms.
struct Asked {
  Arrival stop;                            // from when on they were to come to rest
  std::optional<Arrival> held_from = {};   // from when on none may move; nothing: none was held
  std::optional<Arrival> held_until = {};  // when a hand of the deployment's took one, if it did
  std::string lost = {};                   // the arm whose driver was taken away, if one was
};

/// Judges the arms of a run that is over. An arm that lost its driver says nothing of how it ends.
Verdict judge(const std::vector<DrilledArm>& arms, const std::vector<ArmRecord>& records,
              const Asked& asked);

/// Whether a run has gone on after a fault, arm by arm: every arm that moved when it was fired
/// moves again; where none did, any does.
bool went_on(const std::vector<bool>& moved_at_fault, const std::vector<bool>& moved_after);
/// Which arms did not, for people.
std::string stood_still(const std::vector<DrilledArm>& arms,
                        const std::vector<bool>& moved_at_fault,
                        const std::vector<bool>& moved_after);

}  // namespace armature::drill
