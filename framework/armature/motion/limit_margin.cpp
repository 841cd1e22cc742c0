// SPDX-License-Identifier: Apache-2.0
#include "armature/motion/limit_margin.hpp"

#include <fmt/core.h>

#include <numbers>
#include <optional>
#include <string>
#include <utility>

namespace armature {
namespace {

bool turns(const Joint& joint) { return joint.type == Joint::Type::revolute; }

/// In the unit in which a margin is stated.
std::string in_words(const Joint& joint, double amount) {
  return turns(joint) ? fmt::format("{:.10g} deg", amount * 180 / std::numbers::pi)
                      : fmt::format("{:.10g} mm", amount * 1e3);
}

/// nullopt, or which joint the limits do not let be where it is at home.
std::optional<std::string> home_outside(const RobotModel& narrow) {
  if (!narrow.home()) return std::nullopt;
  const auto home = narrow.to_independent(*narrow.home());
  if (!home) return home.error().text;
  for (int i = 0; i < narrow.dof(); ++i) {
    const double q = (*home)[i], lower = narrow.lower()[i], upper = narrow.upper()[i];
    if (q >= lower && q <= upper) continue;
    const Joint& joint = narrow.joints()[static_cast<std::size_t>(narrow.independent_joint(i))];
    return fmt::format("at home joint {} of robot {} is at {}, and the margin leaves {} to {}",
                       joint.name, narrow.name(), in_words(joint, q), in_words(joint, lower),
                       in_words(joint, upper));
  }
  return std::nullopt;
}

}  // namespace

Expected<RobotModel> narrowed(const RobotModel& model, const JointBound& margin) {
  RobotParts parts = model.parts();
  bool any_turns = false, any_slides = false;
  for (Joint& joint : parts.joints) {
    if (joint.locked) continue;
    (turns(joint) ? any_turns : any_slides) = true;
    const double range = joint.upper - joint.lower;
    const double each = turns(joint) ? margin.turning_rad : margin.sliding_m;
    joint.lower += each;
    joint.upper -= each;
    if (joint.lower < joint.upper) continue;
    return refuse(
        fmt::format("joint {} of robot {} has a range of {}, of which a margin of {} at "
                    "either end leaves nothing",
                    joint.name, model.name(), in_words(joint, range), in_words(joint, each)));
  }
  if (margin.turning_rad > 0 && !any_turns) {
    return refuse(
        fmt::format("a margin for joints that turn, and robot {} has none", model.name()));
  }
  if (margin.sliding_m > 0 && !any_slides) {
    return refuse(
        fmt::format("a margin for joints that slide, and robot {} has none", model.name()));
  }
  RobotModel narrow{std::move(parts)};
  if (auto defect = home_outside(narrow)) return refuse(*defect);
  return narrow;
}

}  // namespace armature
