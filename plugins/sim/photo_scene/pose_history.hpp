// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Geometry>
#include <deque>

#include "armature/values/time.hpp"

namespace armature::sim::photo_scene {

/// Where something was, as far back as is asked for.
class PoseHistory {
 public:
  explicit PoseHistory(double reach_s) : reach_s_{reach_s} {}

  /// Stamps increase.
  void add(Time stamp, const Eigen::Isometry3d& pose) {
    poses_.push_back({stamp, pose});
    while (poses_.size() > 1 && to_seconds(stamp - poses_[1].stamp) >= reach_s_) {
      poses_.pop_front();
    }
  }
  /// The pose then, between two that were added: the position on the line, the rotation along the
  /// great arc. Before the first one: the first; behind the last one: the last. Needs one.
  Eigen::Isometry3d at(Time then) const {
    if (then <= poses_.front().stamp) return poses_.front().pose;
    for (std::size_t i = 1; i < poses_.size(); ++i) {
      if (then <= poses_[i].stamp) return between(poses_[i - 1], poses_[i], then);
    }
    return poses_.back().pose;
  }

 private:
  struct Stamped {
    Time stamp;
    Eigen::Isometry3d pose;
  };

  static Eigen::Isometry3d between(const Stamped& a, const Stamped& b, Time then) {
    const double share = to_seconds(then - a.stamp) / to_seconds(b.stamp - a.stamp);
    if (share >= 1) return b.pose;
    const Eigen::Quaterniond from{a.pose.linear()}, to{b.pose.linear()};
    Eigen::Isometry3d pose{from.slerp(share, to)};
    pose.translation() = (1 - share) * a.pose.translation() + share * b.pose.translation();
    return pose;
  }

  double reach_s_;
  std::deque<Stamped> poses_;
};

}  // namespace armature::sim::photo_scene
