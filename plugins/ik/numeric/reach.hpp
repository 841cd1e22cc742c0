// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <optional>
#include <vector>

#include "armature/kinds/ik/ik.hpp"
#include "descent.hpp"

namespace armature::ik::numeric {

/// What an arm cannot reach, told without an iteration. A point on the axis of a joint does not
/// move with it, so the distance of two points of the arm often depends on a single joint (shoulder
/// and wrist: on the elbow); longer ways are sums of such. Joints turn all the way round here,
/// slides keep their limits: a bound, which not every arm touches.
class Reach {
 public:
  Reach(const RobotModel& model, const descent::Chain& chain);

  /// How far beyond reach `goal` is, more than its tolerance forgives. Real-time safe.
  struct Miss {
    double by;  // [m]
    std::string_view why;
  };
  std::optional<Miss> miss_of(const IkGoal& goal) const;

 private:
  /// Between which distances from a point of the base a point of the last link stays.
  struct Shell {
    Eigen::Vector3d centre, point;  // in the base; in the tool frame
    double along;                   // the point is so far along the pointing axis [m]; or NaN
    double inner, outer;            // [m]
  };
  std::vector<Shell> shells_;
};

}  // namespace armature::ik::numeric
