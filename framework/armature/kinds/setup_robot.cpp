// SPDX-License-Identifier: Apache-2.0
#include "armature/kinds/setup_robot.hpp"

namespace armature {

RobotModel robot_of(Setup& setup) { return read_robot_model(setup.document("robots")); }

StereoRig rig_of(Setup& setup) { return read_stereo_rig(setup.document("rigs")); }

std::optional<StereoRig> optional_rig_of(Setup& setup) {
  if (!setup.has_document("rigs")) return std::nullopt;
  return rig_of(setup);
}

FrameId mount_of(const StereoRig& rig, const RobotModel& robot) {
  const auto mount = robot.find_frame(rig.mounted_on);
  if (!mount) {
    throw SetupError("the rig '" + rig.name + "' is mounted on '" + rig.mounted_on +
                     "', which is no frame of the robot '" + robot.name() + "'");
  }
  return *mount;
}

}  // namespace armature
