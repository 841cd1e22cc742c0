// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>

#include "armature/robot/files/stereo_rig.hpp"
#include "armature/robot/model/robot_model.hpp"
#include "armature/runtime/component/setup.hpp"

namespace armature ARMATURE_EXPORT {

/// The robot (rig) that the deployment binds to this component; plugin.yaml says `uses: [robot]`
/// (`[rig]`). Throws config::ConfigError with every problem of the file.
RobotModel robot_of(Setup& setup);
StereoRig rig_of(Setup& setup);

/// The rig, where the deployment has one for this component; plugin.yaml says `may_use: [rig]`.
std::optional<StereoRig> optional_rig_of(Setup& setup);

/// The frame of the robot that the rig hangs on. Throws SetupError when the robot has none of that
/// name.
FrameId mount_of(const StereoRig& rig, const RobotModel& robot);

}  // namespace armature
