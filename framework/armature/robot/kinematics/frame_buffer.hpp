// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Geometry>
#include <cstddef>
#include <vector>

#include "armature/robot/model/robot_model.hpp"
#include "armature/values/expected.hpp"
#include "armature/values/time.hpp"

namespace armature ARMATURE_EXPORT {

/// Answers "base_T_frame at t" from a bounded history of joint positions and the robot's named
/// frames. Joint positions are interpolated linearly between the two neighbours of t, and carried
/// on beyond the newest sample for no longer than that is after the one before. Neighbours that are
/// more than 0.15 s apart tell nothing of what is between or behind them.
/// No allocation after construction, except for the text of a refusal. Not thread-safe: one owner.
class FrameBuffer {
 public:
  /// Keeps the newest `capacity` joint samples.
  FrameBuffer(const RobotModel& model, std::size_t capacity);

  /// Adds a sample of the independent joints; stamps must ascend, an older or equal one is ignored.
  /// A newest one more than 0.15 s ahead of those before it gives way to one that comes between.
  void add(Time stamp, const JointVector& q);

  /// The independent joints at `t`, or "t = 3.512 s is 12.0 ms newer than the history" / "... older
  /// ...".
  Expected<JointVector> joints_at(Time t) const;
  Expected<Eigen::Isometry3d> base_T(FrameId frame, Time t) const;

  bool empty() const { return count_ == 0; }
  Time newest() const;

 private:
  struct Entry {
    Time stamp;
    JointVector q;
  };
  const Entry& entry(std::size_t age_from_oldest) const;

  const RobotModel* model_;
  std::vector<Entry> ring_;
  std::size_t first_ = 0, count_ = 0;
};

}  // namespace armature
