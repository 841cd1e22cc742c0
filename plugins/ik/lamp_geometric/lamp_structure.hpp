// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "armature/robot/model/robot_model.hpp"
#include "armature/values/expected.hpp"

namespace armature {

/// The lengths of a lamp arm [m], named after its Denavit-Hartenberg table. d1, d2 and d5 shift
/// the lamp along z only.
struct LampLengths {
  double a1 = 0, a3 = 0, a4 = 0, a5 = 0, a6 = 0;
  double d = 0;  // d1 + d2 + d5
};

/// The lengths of `model` if it is built like the lamp (Jiang et al. 2021, Table 1): two vertical
/// axes, a parallelogram theta4 = -theta3, a vertical and a horizontal axis; or the first place
/// where it is not.
Expected<LampLengths> lamp_lengths(const RobotModel& model);

}  // namespace armature
