// SPDX-License-Identifier: Apache-2.0
#include "nearest.hpp"

#include <fmt/format.h>

#include <limits>

#include "armature/runtime/plugins/plugin.hpp"

namespace armature::select::nearest {

double Nearest::travel_time(const JointVector& from, const JointVector& to) const {
  const auto times = (to - from).cwiseAbs().cwiseQuotient(model_->max_velocity());
  return parameters_.nearness == Parameters::Nearness::sum ? times.sum() : times.maxCoeff();
}

Expected<std::vector<JointVector>> Nearest::choose(const JointVector& start,
                                                   std::span<const IkBranches> waypoints) const {
  if (auto wrong = invalid_input(*model_, start, waypoints)) return refuse(*wrong);
  std::vector<JointVector> chosen;
  chosen.reserve(waypoints.size());
  JointVector previous = start;
  for (const IkBranches& branches : waypoints) {
    double nearest = std::numeric_limits<double>::infinity();
    JointVector best;
    for (const IkBranch& branch : branches) {
      JointVector q = branch.q;
      if (!unwind(*model_, previous, q)) continue;
      const double time = travel_time(previous, q);
      if (time < nearest) nearest = time, best = q;
    }
    if (best.size() == 0) {
      const std::size_t place = chosen.size() + 1;
      if (branches.count == 0) {
        return refuse(fmt::format("waypoint {} of {}: no branch", place, waypoints.size()));
      }
      return refuse(fmt::format("waypoint {} of {}: {} {}, none within limits", place,
                                waypoints.size(), branches.count,
                                branches.count == 1 ? "branch" : "branches"));
    }
    chosen.push_back(best);
    previous = best;
  }
  return chosen;
}

}  // namespace armature::select::nearest

ARMATURE_PLUGIN(armature::select::nearest::Nearest);
