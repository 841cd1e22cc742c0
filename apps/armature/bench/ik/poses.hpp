// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <vector>

#include "armature/kinds/ik/ik.hpp"

namespace armature::bench {

/// Where a solver starts from.
enum class Seeds { random, near };
std::string_view to_string(Seeds seeds);

/// A goal that joints within limits reach, and the two seeds that it is asked with.
struct Pose {
  IkGoal goal;
  JointVector q;             // what made it
  JointVector random, near;  // anywhere within limits; every joint within 5 degrees of q
  const JointVector& seed(Seeds seeds) const { return seeds == Seeds::random ? random : near; }
};

/// The same `count` poses for the same robot and seed, wherever and whenever: joints uniform within
/// limits. A slide's "5 degrees" are 2.5 % of its way. Residuals up to `tolerance` [m] and [rad]
/// count as reached.
std::vector<Pose> poses(const RobotModel& model, int count, std::uint64_t seed, double tolerance);

}  // namespace armature::bench
