// SPDX-License-Identifier: Apache-2.0
#include "thread_monitor.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace armature::report::implant {

void ThreadMonitor::see(const Eigen::Vector3d& tool, double angle) {
  if (!thread_) return;
  if (!begun_at_) begun_at_ = angle;
  const double advance_m = std::max(thread_->axis.dot(tool - thread_->start), 0.0);
  const double turned_m = (angle - *begun_at_) / (2 * std::numbers::pi) * thread_->pitch_m;
  max_error_m_ = std::max(max_error_m_.value_or(0), std::abs(advance_m - turned_m));
}

}  // namespace armature::report::implant
