// SPDX-License-Identifier: Apache-2.0
#include "paper_lamp.hpp"

#include "armature/config/document.hpp"
#include "armature/robot/trajectories/trajectory_check.hpp"

namespace armature::paper {

LampExample& paper_lamp() {
  static const config::Node file =
      config::parse_file(ARMATURE_SOURCE_DIR "/docs/papers/dental_lamp.yaml");
  static LampExample lamp{reproduce::Numbers{file}["numbers"],
                          load_robot_model(ARMATURE_SOURCE_DIR "/configs/robots/dental_lamp.yaml")};
  return lamp;
}

Peaks peaks_of(const Trajectory& trajectory) {
  const JointVector one = JointVector::Ones(trajectory.dof);
  const LimitUse use = limit_use(trajectory, one, one);
  return {use.velocity, use.acceleration};
}

}  // namespace armature::paper
