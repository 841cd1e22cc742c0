// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "armature/kinds/ik/batch.hpp"
#include "pose_batch.hpp"
#include "puma_structure.hpp"

namespace armature {

/// Rotations, by an arm whose joints all turn; PoseAnswers::kSpecial where rules of their own are
/// needed. `out` has room.
void solve_together(SolveBatch solve, const PumaArm& arm, const ArmNumbers& numbers,
                    const IkBatch& batch, IkBatchAnswers& out);

}  // namespace armature
