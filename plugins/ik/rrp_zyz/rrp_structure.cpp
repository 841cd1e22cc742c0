// SPDX-License-Identifier: Apache-2.0
#include "rrp_structure.hpp"

#include <fmt/format.h>

#include <cmath>
#include <string>

#include "armature/values/angles.hpp"

namespace armature {
namespace {

using Eigen::Matrix3d;

constexpr double kSame = 1e-9;  // [m] or [rad]

/// The sine of a right angle, +1 or -1; 0 for any other angle.
double right_angle(double alpha) {
  const double sine = std::sin(alpha);
  return std::abs(std::cos(alpha)) < kSame ? std::round(sine) : 0;
}

/// Why joint `i` is not the arm's; empty when it is.
std::string joint_mismatch(const Joint& joint, std::size_t i) {
  const auto must_be_zero = [&](std::string_view what, double found) {
    return fmt::format("joint '{}': {} must be 0, it is {:g}", joint.name, what, found);
  };
  const bool slides = joint.type == Joint::Type::prismatic;
  if (slides != (i == kSlide)) {
    return fmt::format("joint '{}' must be {}", joint.name, slides ? "revolute" : "prismatic");
  }
  if (joint.coupling) return fmt::format("joint '{}' is coupled", joint.name);
  if (joint.locked) return fmt::format("joint '{}' is locked", joint.name);
  if (joint.placement) return fmt::format("joint '{}' is placed beside its row", joint.name);
  if (std::abs(joint.a) > kSame) return must_be_zero("a_m", joint.a);
  if (!slides && std::abs(joint.d) > kSame) return must_be_zero("d_m", joint.d);
  if (i == 0 || right_angle(joint.alpha) != 0) return {};
  if (i == 3 && std::abs(std::sin(joint.alpha)) < kSame) return {};
  return fmt::format("joint '{}': alpha_deg must be {}, it is {:.10g}", joint.name,
                     i == 3 ? "a multiple of 90" : "90 or -90", joint.alpha / kRadPerDegree);
}

/// Rx of a multiple of 90 degrees without rounding, of any other angle as it is.
Matrix3d about_x(double angle) {
  Matrix3d turn = Eigen::AngleAxisd{angle, Eigen::Vector3d::UnitX()}.toRotationMatrix();
  for (double& entry : turn.reshaped()) {
    if (std::abs(entry - std::round(entry)) < 1e-15) entry = std::round(entry);
  }
  return turn;
}

RrpArm numbers_of(const RobotModel& model) {
  const auto& joints = model.joints();
  RrpArm arm;
  arm.l3 = joints[kSlide].d;
  arm.s1 = right_angle(joints[1].alpha);
  arm.s2 = right_angle(joints[2].alpha);
  arm.s4 = right_angle(joints[4].alpha);
  arm.s5 = right_angle(joints[5].alpha);
  arm.across = right_angle(joints[3].alpha) != 0;
  for (std::size_t i = 0; i < 6; ++i) {
    if (i != kSlide) arm.theta[i] = wrap_angle(joints[i].theta);
    arm.lower[i] = model.lower()[static_cast<int>(i)];
    arm.upper[i] = model.upper()[static_cast<int>(i)];
  }
  const Eigen::AngleAxisd slide{-joints[kSlide].theta, Eigen::Vector3d::UnitZ()};
  arm.column_R_base = about_x(-joints[0].alpha);
  arm.wrist_R_slide = about_x(-joints[3].alpha) * slide.toRotationMatrix();
  const Eigen::Isometry3d& hand_T_tool = model.frame(model.tool()).parent_T_frame;
  arm.hand_t_tool = hand_T_tool.translation();
  arm.tool_R_hand = hand_T_tool.linear().transpose();
  arm.tool_t_hand = -(arm.tool_R_hand * arm.hand_t_tool);
  return arm;
}

Expected<RrpArm> refuse_arm(std::string_view why) {
  return refuse(fmt::format("not a polar arm with a ZYZ wrist: {}", why));
}

}  // namespace

Expected<RrpArm> rrp_arm(const RobotModel& model) {
  if (model.convention() != RobotModel::Convention::modified) {
    return refuse_arm("its Denavit-Hartenberg convention is not modified");
  }
  const auto& joints = model.joints();
  if (joints.size() != 6) {
    return refuse_arm(
        fmt::format("6 joints needed, '{}' has {}", model.name(), model.joint_count()));
  }
  for (std::size_t i = 0; i < joints.size(); ++i) {
    if (const auto why = joint_mismatch(joints[i], i); !why.empty()) return refuse_arm(why);
  }
  if (const double least = joints[kSlide].d + joints[kSlide].lower; !(least > kSame)) {
    return refuse_arm(
        fmt::format("joint '{}': d_m plus the lower limit must be positive, it is "
                    "{:g}",
                    joints[kSlide].name, least));
  }
  if (model.frame(model.tool()).parent_joint != 5) {
    return refuse_arm(fmt::format("its tool must hang on joint '{}'", joints[5].name));
  }
  if (model.pointing_axis()) {
    return refuse_arm("it has a pointing axis, and six joints leave the turn about it open");
  }
  return numbers_of(model);
}

}  // namespace armature
