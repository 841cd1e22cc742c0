// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string_view>

#include "armature/kinds/ik/ik.hpp"
#include "puma_structure.hpp"

namespace armature {

Rims rims_of(const PumaArm& arm, const IkGoal::Tolerance& tolerance);

/// A goal in PumaArm's form, seen from the shoulder frame.
struct PumaGoal {
  ArmQuestion at_zero;  // with the needle at 0
  Triple needle;        // what the lever grows by per metre of needle; 0 without one

  /// The same with the needle at `depth` [m].
  ArmQuestion at(double depth) const;
};
/// A direction needs an arm with PumaArm::pointing. What is free is kept from `seed`, brought
/// within limits.
PumaGoal puma_goal(const PumaArm& arm, const IkGoal& goal, const JointVector& seed);

/// How far a wrist is beyond what a shoulder reaches [m], below 0 how far within, and why. `side`:
/// 1 of shoulder 0, -1 of shoulder 1.
struct Miss {
  double by = 0;
  std::string_view why;
};
Miss miss_of(const ArmNumbers& arm, const Triple& wrist, double side);
/// Of the shoulder that misses it least.
Miss min_miss(const ArmNumbers& arm, const Triple& wrist);

}  // namespace armature
