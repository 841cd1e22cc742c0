// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "puma_goal.hpp"

namespace armature {

/// A goal for an arm with a needle, and the depths [m] that the needle can take.
struct NeedleTask {
  const ArmKernel& kernel;
  const ArmNumbers& arm;
  const PumaGoal& goal;
  double least, most;

  /// The range in equal steps: both searches over depth begin with these.
  static constexpr int kSteps = 256;
  double depth_at(int step) const {
    return step == kSteps ? most : least + (most - least) * step / kSteps;
  }
};

}  // namespace armature
