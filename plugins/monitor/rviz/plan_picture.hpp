// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>

#include "armature/messages/armature_msgs.hpp"
#include "armature/messages/geometry_msgs.hpp"
#include "armature/messages/visualization_msgs.hpp"
#include "image_in_base.hpp"

namespace armature::monitor::rviz {

/// What is planned and what is to be kept away from; nullptr: nothing is known of it.
struct Plans {
  const msg::NeedlePlan* needle = nullptr;
  const msg::ImplantPlan* implant = nullptr;
  const msg::PointStamped* incision = nullptr;
  const msg::MotionGoal* way = nullptr;  // the planned goal whose way the arm is on, or was last
};

/// All of it as markers in `base_frame`, each array complete: it begins by taking everything away.
/// Namespaces `head`, `vessels`, `lesion`, `entry`, `needle`; `jaw`, `sites`; `incision`; `zones`,
/// those of the way. A plan on images is not drawn before it is known where the
/// image lies.
msg::MarkerArray draw_plans(const Plans& plans, const ImageInBase& image,
                            const std::string& base_frame, Time stamp);

}  // namespace armature::monitor::rviz
