// SPDX-License-Identifier: Apache-2.0
#include "armature/robot/kinematics/frame_buffer.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "armature/robot/kinematics/kinematics.hpp"

namespace armature {
namespace {

/// Neighbours that are farther apart do not tell what the arm did between them. The slowest arms
/// report ten times a second.
constexpr Duration kFarthestApart = std::chrono::milliseconds{150};

Expected<JointVector> outside(Time t, Duration by, std::string_view side) {
  return refuse(fmt::format("t = {:.3f} s is {:.1f} ms {} than the history", to_seconds(t - Time{}),
                            to_seconds(by) * 1e3, side));
}

}  // namespace

FrameBuffer::FrameBuffer(const RobotModel& model, std::size_t capacity)
    : model_(&model), ring_(std::max<std::size_t>(capacity, 1)) {}

void FrameBuffer::add(Time stamp, const JointVector& q) {
  if (!empty() && stamp <= newest()) {
    // A newest sample that lies far ahead of all others is the one whose stamp is wrong.
    const bool is_newest_alone = count_ > 1 && newest() - entry(count_ - 2).stamp > kFarthestApart;
    if (!is_newest_alone || stamp <= entry(count_ - 2).stamp) return;
    ring_[(first_ + count_ - 1) % ring_.size()] = {stamp, q};
  } else if (count_ < ring_.size()) {
    ring_[(first_ + count_++) % ring_.size()] = {stamp, q};
  } else {
    ring_[first_] = {stamp, q};
    first_ = (first_ + 1) % ring_.size();
  }
}

const FrameBuffer::Entry& FrameBuffer::entry(std::size_t age_from_oldest) const {
  return ring_[(first_ + age_from_oldest) % ring_.size()];
}

Time FrameBuffer::newest() const { return empty() ? Time{} : entry(count_ - 1).stamp; }

Expected<JointVector> FrameBuffer::joints_at(Time t) const {
  if (empty()) return refuse("no joint positions have arrived yet");
  // A picture may come before the arm's own sample of that instant.
  const Duration step = count_ < 2 ? Duration{0} : newest() - entry(count_ - 2).stamp;
  if (t - newest() > step) return outside(t, t - newest(), "newer");
  if (t < entry(0).stamp) return outside(t, entry(0).stamp - t, "older");

  std::size_t before = 0, after = count_ - 1;  // next to t, or the newest two
  while (after - before > 1) {
    const std::size_t middle = (before + after) / 2;
    (entry(middle).stamp <= t ? before : after) = middle;
  }
  const Entry &a = entry(before), &b = entry(after);
  if (t == b.stamp) return b.q;
  if (t == a.stamp) return a.q;
  if (b.stamp - a.stamp > kFarthestApart) {
    return refuse(fmt::format("the joint positions next to t = {:.3f} s are {:.3f} s apart",
                              to_seconds(t - Time{}), to_seconds(b.stamp - a.stamp)));
  }
  const double part = to_seconds(t - a.stamp) / to_seconds(b.stamp - a.stamp);
  return JointVector{a.q + part * (b.q - a.q)};
}

Expected<Eigen::Isometry3d> FrameBuffer::base_T(FrameId frame, Time t) const {
  return joints_at(t).map(
      [&](const JointVector& q) { return forward_kinematics(*model_, q, frame); });
}

}  // namespace armature
