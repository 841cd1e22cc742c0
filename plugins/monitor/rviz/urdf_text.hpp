// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "armature/robot/model/robot_model.hpp"
#include "frame_tree.hpp"

namespace armature::monitor::rviz {

/// The robot as a URDF file: a link for every frame of `tree`, called as /tf calls it; joints
/// called as in JointState, with their limits, couplings (mimic) and locked ones (fixed); the same
/// cylinders and bars as the markers. URDF wants an effort, which no robot file states: it is 0. A
/// joint without a limit of speed, and a slide without ends, are told with 1e9. Source: the URDF
/// format of ROS, wiki.ros.org/urdf/XML.
std::string urdf_text(const RobotModel& model, const FrameTree& tree);

}  // namespace armature::monitor::rviz
