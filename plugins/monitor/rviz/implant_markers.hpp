// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Geometry>
#include <optional>

#include "armature/messages/armature_msgs.hpp"
#include "markers.hpp"

namespace armature::monitor::rviz {

/// An implant's plan in the frame of `head`, moved there by the registration: the jaw by the points
/// that were marked on it and, where it is tracked, its body (namespace `jaw`, ids 0 and 1), and
/// every site as an arrow along the drill to the bottom of its bore (`sites`). What is not finite
/// is left out.
void add_implant_plan(const MarkerHead& head, const msg::ImplantPlan& plan,
                      const Eigen::Affine3d& base_T_image,
                      const std::optional<Eigen::Isometry3d>& base_T_jaw, msg::MarkerArray& array);

}  // namespace armature::monitor::rviz
