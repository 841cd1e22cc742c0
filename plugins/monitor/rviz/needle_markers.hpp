// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Geometry>

#include "armature/messages/armature_msgs.hpp"
#include "markers.hpp"

namespace armature::monitor::rviz {

/// A needle's plan in the frame of `head`, moved there by the registration: the head by the balls
/// on it (namespace `head`), `vessels`, `lesion`, `entry`, and the straight way between the last
/// two (`needle`). What is not finite is left out.
void add_needle_plan(const MarkerHead& head, const msg::NeedlePlan& plan,
                     const Eigen::Affine3d& base_T_image, msg::MarkerArray& array);

}  // namespace armature::monitor::rviz
