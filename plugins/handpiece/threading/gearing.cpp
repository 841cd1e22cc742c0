// SPDX-License-Identifier: Apache-2.0
#include "gearing.hpp"

namespace armature::handpiece::threading {

void Gearing::engage(const Thread& thread, double angle) {
  thread_ = thread;
  begun_at_ = angle_ = angle;
}

Turn Gearing::follow(const Eigen::Vector3d& tool, const Eigen::Vector3d& velocity) {
  if (!thread_) return {.angle = angle_};
  const double advance_m = thread_->advance_m(tool);
  angle_ = begun_at_ + thread_->angle(advance_m);
  if (advance_m == 0) return {.angle = angle_};
  return {.angle = angle_, .velocity = thread_->angle(thread_->axis.dot(velocity))};
}

}  // namespace armature::handpiece::threading
