// SPDX-License-Identifier: Apache-2.0
#pragma once

namespace armature::task::teleoperation {

/// Between two poses of the hand: a step of the task.
inline constexpr double kHandPeriod_s = 0.001;

}  // namespace armature::task::teleoperation
