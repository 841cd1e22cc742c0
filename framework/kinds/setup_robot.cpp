// SPDX-License-Identifier: Apache-2.0
#include "armature/kinds/setup_robot.hpp"

#include "armature/config/problems.hpp"

namespace armature {

RobotModel robot_of(Setup& setup) {
  config::Problems problems;
  auto robot = read_robot_model(setup.document("robots"), problems);
  problems.throw_if_any();
  return std::move(*robot);
}

StereoRig rig_of(Setup& setup) {
  config::Problems problems;
  auto rig = read_stereo_rig(setup.document("rigs"), problems);
  problems.throw_if_any();
  return std::move(*rig);
}

}  // namespace armature
