// SPDX-License-Identifier: Apache-2.0
#include "armature/motion/goal.hpp"

#include <fmt/core.h>

#include <cmath>
#include <string>

namespace armature {
namespace {

constexpr double kLengthTolerance = 0.01;

template <class Vector>
bool finite(const Vector& vector) {
  return vector.allFinite();
}

Expected<Orientation> unit_orientation(const Orientation& orientation) {
  const bool pointing = std::holds_alternative<Direction>(orientation);
  const double length = pointing ? std::get<Direction>(orientation).unit.norm()
                                 : std::get<Eigen::Quaterniond>(orientation).norm();
  // A comparison that is false for NaN as well.
  if (!(std::abs(length - 1) <= kLengthTolerance)) {
    return refuse(fmt::format("the goal's {} has length {:.6g}, not 1",
                              pointing ? "direction" : "quaternion", length));
  }
  if (pointing) return Direction{std::get<Direction>(orientation).unit / length};
  return std::get<Eigen::Quaterniond>(orientation).normalized();
}

}  // namespace

Expected<MotionGoal> checked(MotionGoal goal) {
  if (goal.mode == MotionMode::hold) return goal;
  if (!finite(goal.pose.position)) return refuse("the goal's position is not finite");
  if (!finite(goal.velocity)) return refuse("the goal's velocity is not finite");
  if (goal.focus && !finite(*goal.focus)) return refuse("the goal's focus is not finite");
  auto orientation = unit_orientation(goal.pose.orientation);
  if (!orientation) return tl::unexpected{orientation.error()};
  goal.pose.orientation = *orientation;
  return goal;
}

}  // namespace armature
