// SPDX-License-Identifier: Apache-2.0
#include "armature/motion/limit_margin.hpp"

#include <fmt/core.h>

#include <optional>
#include <vector>

namespace armature {

Expected<RobotModel> narrowed(const RobotModel& model, const LimitMargin& margin) {
  std::vector<Joint> joints = model.joints();
  for (Joint& joint : joints) {
    const bool turns = joint.type == Joint::Type::revolute;
    const double each = turns ? margin.turning_rad : margin.sliding_m;
    joint.lower += each;
    joint.upper -= each;
    if (joint.lower < joint.upper) continue;
    return refuse(fmt::format(
        "joint {} of robot {} has a range of {:.4g} {}, of which a margin of "
        "{:.4g} leaves nothing",
        joint.name, model.name(), joint.upper - joint.lower + 2 * each, turns ? "rad" : "m", each));
  }
  return RobotModel{model.name(), model.convention(),    joints,      model.frames(),
                    model.tool(), model.pointing_axis(), model.home()};
}

}  // namespace armature
