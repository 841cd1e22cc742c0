// SPDX-License-Identifier: Apache-2.0
#include "insertion_monitor.hpp"

#include <algorithm>
#include <cmath>

namespace armature::report::biopsy {

void InsertionMonitor::see_tip(const Eigen::Vector3d& tip, const Eigen::Vector3d& axis,
                               const JointVector& turning) {
  tip_ = tip;
  if (!needle_) return;
  const Eigen::Vector3d along = (needle_->target - needle_->entry).normalized();
  const Eigen::Vector3d from_entry = tip - needle_->entry;
  constexpr double kAtEntry = 0.001, kPastEntry = 1e-4;  // [m]: at the entry the approach ends
  // A needle that was drawn out may go past the head, at any height.
  if (along.dot(from_entry) < -kAtEntry) {
    entered_ = false;
    at_entry_.reset();
  }
  if (!entered_ && from_entry.norm() > kAtEntry) return;
  entered_ = true;
  if (along.dot(from_entry) < kPastEntry) return;
  if (!at_entry_) at_entry_ = turning;
  const auto keep_largest = [](std::optional<double>& kept, double value) {
    kept = std::max(kept.value_or(0), value);
  };
  keep_largest(deviation_m_, (from_entry - along.dot(from_entry) * along).norm());
  keep_largest(tilt_rad_, std::atan2(axis.cross(along).norm(), axis.dot(along)));
  const double turned = turning.size() > 0 ? (turning - *at_entry_).cwiseAbs().maxCoeff() : 0;
  keep_largest(turned_rad_, turned);
  const Eigen::Vector3d at_entry = tip - along.dot(from_entry) * axis;
  for (const ForbiddenZone& vessel : vessels_) {
    const double distance = clearance(at_entry, tip, vessel);
    vessel_distance_m_ = std::min(vessel_distance_m_.value_or(distance), distance);
  }
}

}  // namespace armature::report::biopsy
