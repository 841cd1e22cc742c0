// SPDX-License-Identifier: Apache-2.0
#include "armature/motion/reference.hpp"

#include <algorithm>
#include <iterator>
#include <utility>

namespace armature {

void Reference::start(const JointVector& q, Time now) {
  plan_.clear();
  plan_.push_back(hold_at(q, now, 0));
}

void Reference::splice(Trajectory next) {
  std::erase_if(plan_, [&](const Trajectory& t) { return t.start >= next.start; });
  plan_.push_back(std::move(next));
}

void Reference::advance(Time now) {
  while (plan_.size() > 1 && plan_[1].start <= now) plan_.erase(plan_.begin());
}

const Trajectory& Reference::trajectory_at(Time time) const {
  const auto later = std::find_if(plan_.begin() + 1, plan_.end(),
                                  [&](const Trajectory& t) { return t.start > time; });
  return *std::prev(later);
}

}  // namespace armature
