// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Geometry>
#include <map>
#include <stdexcept>
#include <string>

#include "armature/messages/geometry.hpp"
#include "armature/messages/tf2_msgs.hpp"

namespace armature::testing {

/// What a tf2 listener knows: every frame's parent, and the way there.
class TfListener {
 public:
  void hear(const msg::TFMessage& message) {
    for (const msg::TransformStamped& edge : message.transforms_()) {
      if (!parents_.try_emplace(edge.child_frame_id_(), edge.header_().frame_id_()).second) {
        throw std::logic_error("'" + edge.child_frame_id_() + "' has two parents");
      }
      transforms_[edge.child_frame_id_()] = to_eigen(edge.transform_());
    }
  }
  /// a_T_b for a frame `a` on the way from `b` to the root.
  Eigen::Isometry3d transform(const std::string& a, const std::string& b) const {
    Eigen::Isometry3d way = Eigen::Isometry3d::Identity();
    for (std::string at = b; at != a; at = parents_.at(at)) way = transforms_.at(at) * way;
    return way;
  }
  std::size_t size() const { return parents_.size(); }
  const std::string& parent(const std::string& frame) const { return parents_.at(frame); }

 private:
  std::map<std::string, std::string> parents_;
  std::map<std::string, Eigen::Isometry3d> transforms_;
};

}  // namespace armature::testing
