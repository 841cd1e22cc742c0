// SPDX-License-Identifier: Apache-2.0
#include "joint_move.hpp"

#include "armature/runtime/plugin.hpp"

namespace armature {

Expected<std::unique_ptr<PathPlanner>> JointMove::make(const Params& params) {
  const double duration_s = params.number("duration_s");
  return std::unique_ptr<PathPlanner>{
      new JointMove{duration_s > 0 ? std::optional{duration_s} : std::nullopt}};
}

Expected<Path> JointMove::plan(const PathRequest& request) const {
  const auto valid = checked(request);
  if (!valid) return tl::unexpected{valid.error()};
  return Path{{.space = PathSegment::Space::joint,
               .samples = {{.s = 1, .pose = valid->goal}},
               .stop_at_end = true,
               .duration_s = duration_s_}};
}

}  // namespace armature

ARMATURE_PLUGIN(armature::JointMove);
