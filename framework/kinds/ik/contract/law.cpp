// SPDX-License-Identifier: Apache-2.0
#include "armature/kinds/ik/contract/law.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <array>
#include <exception>

#include "armature/kinds/ik/contract/laws.hpp"
#include "armature/kinds/ik/contract/probe.hpp"

namespace armature {

#define ARMATURE_IK_LAW_ENTRY(Name, function, says) IkLaw{#Name, says, &ik_contract::function},
std::span<const IkLaw> ik_laws() {
  static constexpr std::array kLaws{ARMATURE_IK_LAWS(ARMATURE_IK_LAW_ENTRY)};
  return kLaws;
}
#undef ARMATURE_IK_LAW_ENTRY

IkLawReport check_law(const IkLaw& law, const IkSubject& subject, const IkLawTools& tools) {
  ik_contract::Probe probe{subject, tools};
  try {
    law.check(probe);
  } catch (const std::exception& error) {
    probe.violated(fmt::format("the solver throws: {}", error.what()));
  }
  return probe.report();
}

std::string question_line(const RobotModel& model, const IkGoal& goal, const JointVector& seed) {
  std::string line = fmt::format("{{\"position_m\":[{}]", fmt::join(goal.pose.position, ","));
  if (const auto* direction = std::get_if<Direction>(&goal.pose.orientation)) {
    line += fmt::format(",\"direction\":[{}]", fmt::join(direction->unit, ","));
  } else {
    const auto& rotation = std::get<Eigen::Quaterniond>(goal.pose.orientation);
    line += fmt::format(",\"quaternion_xyzw\":[{}]", fmt::join(rotation.coeffs(), ","));
  }
  if (goal.redundancy) line += fmt::format(",\"redundancy_rad\":{}", *goal.redundancy);
  const IkGoal::Tolerance usual;
  if (goal.tolerance.position_m != usual.position_m) {
    line += fmt::format(",\"tolerance_m\":{}", goal.tolerance.position_m);
  }
  if (goal.tolerance.angle_rad != usual.angle_rad) {
    line += fmt::format(",\"tolerance_rad\":{}", goal.tolerance.angle_rad);
  }
  if (seed.size() == model.dof()) {
    const JointVector all = model.expand(seed);
    line += fmt::format(",\"seed\":[{}]", fmt::join(all, ","));
  }
  return line + "}";
}

}  // namespace armature
