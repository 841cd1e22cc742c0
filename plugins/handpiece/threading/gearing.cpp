// SPDX-License-Identifier: Apache-2.0
#include "gearing.hpp"

#include <cmath>
#include <numbers>

namespace armature::handpiece::threading {

const char* defect(const Thread& thread) {
  constexpr double kMinPitch_m = 1e-4, kUnit = 1e-6;
  if (!thread.start.allFinite()) return "the thread's start is not finite";
  if (!(std::abs(thread.axis.norm() - 1) <= kUnit)) return "the thread's axis is no unit vector";
  if (!(thread.pitch_m >= kMinPitch_m)) return "the thread's pitch is below 0.1 mm";
  return nullptr;
}

void Gearing::engage(const Thread& thread, double angle) {
  thread_ = thread;
  begun_at_ = angle_ = angle;
}

Turn Gearing::follow(const Eigen::Vector3d& tool, const Eigen::Vector3d& velocity) {
  if (!thread_) return {.angle = angle_};
  const double advance_m = thread_->axis.dot(tool - thread_->start);
  if (advance_m <= 0) {
    angle_ = begun_at_;
    return {.angle = angle_};
  }
  const double turn_per_m = 2 * std::numbers::pi / thread_->pitch_m;
  angle_ = begun_at_ + turn_per_m * advance_m;
  return {.angle = angle_, .velocity = turn_per_m * thread_->axis.dot(velocity)};
}

}  // namespace armature::handpiece::threading
