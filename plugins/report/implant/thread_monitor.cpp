// SPDX-License-Identifier: Apache-2.0
#include "thread_monitor.hpp"

#include <algorithm>
#include <cmath>

namespace armature::report::implant {

void ThreadMonitor::see(const Eigen::Vector3d& tool, double angle) {
  if (!thread_) return;
  is_known_ = is_known_ && std::isfinite(angle);
  if (!begun_at_) begun_at_ = angle;
  const double ahead_m = thread_->ahead_m(tool, angle - *begun_at_);
  max_error_m_ = std::max(max_error_m_.value_or(0), std::abs(ahead_m));
  if (!is_known_) max_error_m_.reset();
}

}  // namespace armature::report::implant
