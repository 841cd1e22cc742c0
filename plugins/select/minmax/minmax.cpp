// SPDX-License-Identifier: Apache-2.0
#include "minmax.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <numbers>

#include "armature/runtime/plugins/plugin.hpp"

namespace armature::select::minmax {

Expected<std::unique_ptr<BranchSelector>> MinMax::make(const RobotModel& model,
                                                       const Params& params) {
  const auto parameters = Parameters::read(params);
  const bool weighs =
      !model.masses().empty() || std::ranges::any_of(model.joints(), [](const Joint& joint) {
        return joint.drive_inertia > 0;
      });
  if (parameters.move_size == Parameters::MoveSize::inertia && !weighs) {
    return refuse(
        fmt::format("move_size: inertia, and the file of robot '{}' states none; add "
                    "masses: or drive_inertia_kg_m2",
                    model.name()));
  }
  return std::make_unique<MinMax>(model, parameters);
}

Expected<Waypoints> MinMax::that_can_stand(std::span<const IkBranches> waypoints) const {
  Waypoints standing(waypoints.size());
  for (std::size_t k = 0; k < waypoints.size(); ++k) {
    for (const IkBranch& branch : waypoints[k]) {
      if (moves_.can_stand(branch)) standing[k].push_back(&branch);
    }
    if (!standing[k].empty()) continue;
    const int count = waypoints[k].count;
    if (count == 0)
      return refuse(fmt::format("waypoint {} of {}: no branch", k + 1, waypoints.size()));
    return refuse(fmt::format("waypoint {} of {}: {} {}, none within limits", k + 1,
                              waypoints.size(), count, count == 1 ? "branch" : "branches"));
  }
  return standing;
}

/// Only rules can bar the way: without them every branch that can stand is reached from anywhere.
std::string MinMax::blocked(const Layers& layers, const Waypoints& waypoints) const {
  const std::size_t place = layers.of.size();
  const std::string before = place == 1 ? "the start" : fmt::format("waypoint {}", place - 1);
  std::string rules;
  if (parameters_.one_branch && place > 1) rules += " in one branch";
  if (parameters_.jump_limit > 0) {
    rules += fmt::format(" by turns of at most {:.6g} deg",
                         parameters_.jump_limit * 180 / std::numbers::pi);
  }
  const std::size_t count = waypoints[place - 1].size();
  return fmt::format("waypoint {} of {}: {} {} within limits, not to be reached from {}{}", place,
                     waypoints.size(), count, count == 1 ? "branch" : "branches", before, rules);
}

Expected<std::vector<JointVector>> MinMax::choose(const JointVector& start,
                                                  std::span<const IkBranches> waypoints) const {
  if (auto wrong = invalid_input(*model_, start, waypoints)) return refuse(*wrong);
  const auto standing = that_can_stand(waypoints);
  if (!standing) return tl::unexpected{standing.error()};
  if (standing->empty()) return std::vector<JointVector>{};
  const auto least = LeastPath{moves_, *standing, Measure::greatest}.from(start);
  if (!least.complete(*standing)) return refuse(blocked(least, *standing));
  const LeastPath shortest{moves_, *standing, Measure::sum, least.least() + kEqual};
  return shortest.first_of(shortest.from(start));
}

}  // namespace armature::select::minmax

ARMATURE_PLUGIN(armature::select::minmax::MinMax);
