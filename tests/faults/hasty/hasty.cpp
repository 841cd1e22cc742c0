// SPDX-License-Identifier: Apache-2.0
#include "armature/kinds/trajectory/trajectory_planner.hpp"
#include "armature/runtime/plugins/plugin.hpp"

namespace armature {

class Hasty final : public TrajectoryPlanner {
 public:
  Expected<Trajectory> plan(const TrajectoryRequest&) const override {
    return refuse("only there to be checked");
  }
};

}  // namespace armature

ARMATURE_PLUGIN(armature::Hasty);
