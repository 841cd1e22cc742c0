// SPDX-License-Identifier: Apache-2.0
#include "joint_move.hpp"

#include "armature/runtime/plugins/plugin.hpp"

namespace armature::path::joint_move {

Expected<Path> JointMove::plan(const PathRequest& request) const {
  const auto valid = checked(request);
  if (!valid) return tl::unexpected{valid.error()};
  const double duration_s = parameters_.duration;
  return Path{{.space = PathSegment::Space::joint,
               .samples = {{.s = 1, .pose = valid->goal}},
               .stop_at_end = true,
               .duration_s = duration_s > 0 ? std::optional{duration_s} : std::nullopt}};
}

}  // namespace armature::path::joint_move

ARMATURE_PLUGIN(armature::path::joint_move::JointMove);
