// SPDX-License-Identifier: Apache-2.0
#include "armature/kinds/select/select.hpp"

#include <fmt/format.h>

#include "armature/values/guarded.hpp"

namespace armature {
namespace {

std::string defect(const RobotModel& model, const JointVector& q) {
  if (q.size() != model.dof()) {
    return fmt::format("has {} joints, not the {} independent ones of {}", q.size(), model.dof(),
                       model.name());
  }
  return q.allFinite() ? "" : "is not finite";
}

}  // namespace

std::optional<std::string> invalid_input(const RobotModel& model, const JointVector& start,
                                         std::span<const IkBranches> waypoints) {
  if (auto wrong = defect(model, start); !wrong.empty()) return "the start " + wrong;
  for (std::size_t i = 0; i < waypoints.size(); ++i) {
    for (const IkBranch& branch : waypoints[i]) {
      if (auto wrong = defect(model, branch.q); !wrong.empty()) {
        return fmt::format("waypoint {} of {}: a branch {}", i + 1, waypoints.size(), wrong);
      }
    }
  }
  return std::nullopt;
}

Expected<std::vector<JointVector>> chosen_by(const BranchSelector& selector,
                                             const RobotModel& model, const JointVector& start,
                                             std::span<const IkBranches> waypoints) {
  auto chosen = guarded([&] { return selector.choose(start, waypoints); });
  if (!chosen) return chosen;
  if (chosen->size() != waypoints.size()) {
    return refuse(fmt::format("the plugin answered for {} of {} waypoints", chosen->size(),
                              waypoints.size()));
  }
  for (std::size_t i = 0; i < chosen->size(); ++i) {
    if (auto wrong = defect(model, (*chosen)[i]); !wrong.empty()) {
      return refuse(
          fmt::format("waypoint {} of {}: the plugin's answer {}", i + 1, waypoints.size(), wrong));
    }
  }
  return chosen;
}

}  // namespace armature
