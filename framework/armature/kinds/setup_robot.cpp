// SPDX-License-Identifier: Apache-2.0
#include "armature/kinds/setup_robot.hpp"

#include <string>
#include <vector>

#include "armature/config/problems.hpp"

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
    std::vector<std::string> names;
    for (const NamedFrame& frame : robot.frames()) names.push_back(frame.name);
    throw SetupError("the rig '" + rig.name + "' is mounted on '" + rig.mounted_on +
                     "', which is no frame of the robot '" + robot.name() + "'" +
                     config::did_you_mean(rig.mounted_on, names));
  }
  return *mount;
}

}  // namespace armature
