// SPDX-License-Identifier: Apache-2.0
#include "armature/robot/geometry/pose_goal.hpp"

#include <fmt/format.h>

#include <cmath>

namespace armature {
namespace {

constexpr double kLengthTolerance = 0.01;
constexpr double kLengthRounding =
    1e-15;  // of a length that is 1: dividing by it would only cost digits

double length_of(const Orientation& orientation) {
  const auto* direction = std::get_if<Direction>(&orientation);
  return direction ? direction->unit.norm() : std::get<Eigen::Quaterniond>(orientation).norm();
}

}  // namespace

ReasonText defect(const ToolPose& pose, std::string_view whose) {
  if (!pose.position.allFinite()) return ReasonText::format("{} position is not finite", whose);
  const double length = length_of(pose.orientation);
  // A comparison that is false for NaN as well.
  if (std::abs(length - 1) <= kLengthTolerance) return {};
  const bool pointing = std::holds_alternative<Direction>(pose.orientation);
  return ReasonText::format("{} {} has length {:.6g}, not 1", whose,
                            pointing ? "direction" : "quaternion", length);
}

Expected<ToolPose> checked(ToolPose pose, std::string_view whose) {
  if (const ReasonText wrong = defect(pose, whose); !wrong.empty()) {
    return refuse(std::string{wrong.view()});
  }
  auto* direction = std::get_if<Direction>(&pose.orientation);
  const double length = length_of(pose.orientation);
  if (std::abs(length - 1) <= kLengthRounding) return pose;
  if (direction) {
    direction->unit /= length;
  } else {
    std::get<Eigen::Quaterniond>(pose.orientation).normalize();
  }
  return pose;
}

PoseResidual residual(const Eigen::Isometry3d& base_T_tool, const Eigen::Vector3d& pointing_axis,
                      const ToolPose& goal) {
  PoseResidual result;
  result.position_m = (base_T_tool.translation() - goal.position).norm();
  if (const auto* rotation = std::get_if<Eigen::Quaterniond>(&goal.orientation)) {
    const Eigen::Quaterniond base_Q_tool{base_T_tool.linear()};
    result.angle_rad = base_Q_tool.angularDistance(*rotation);
  } else {
    // atan2 of sine and cosine keeps all digits for small angles, acos would lose half of them.
    const Eigen::Vector3d& wanted = std::get<Direction>(goal.orientation).unit;
    const Eigen::Vector3d pointing = base_T_tool.linear() * pointing_axis;
    result.angle_rad = std::atan2(pointing.cross(wanted).norm(), pointing.dot(wanted));
  }
  return result;
}

}  // namespace armature
