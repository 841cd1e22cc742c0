// SPDX-License-Identifier: Apache-2.0
#include "lamp_structure.hpp"

#include <fmt/format.h>

#include <array>
#include <cmath>
#include <string>

#include "armature/values/angles.hpp"

namespace armature {
namespace {

constexpr double kSame = 1e-9;  // [m] or [rad]
constexpr std::array<double, 6> kTwistDeg{0, 90, 0, -90, 90, 0};
constexpr int kBalance = 2, kParallelogram = 3;

/// Why joint `i` is not the lamp's; empty when it is.
std::string joint_mismatch(const Joint& joint, std::size_t i) {
  const auto must = [&](std::string_view what, double wanted, double found) {
    return fmt::format("joint '{}': {} must be {:g}, it is {:.10g}", joint.name, what, wanted,
                       found);
  };
  if (joint.type != Joint::Type::revolute)
    return fmt::format("joint '{}' is not revolute", joint.name);
  if (joint.locked) return fmt::format("joint '{}' is locked", joint.name);
  if (joint.placement) return fmt::format("joint '{}' is placed beside its row", joint.name);
  if (std::abs(joint.alpha - kTwistDeg[i] * kRadPerDegree) > kSame) {
    return must("alpha_deg", kTwistDeg[i], joint.alpha / kRadPerDegree);
  }
  if (std::abs(joint.theta) > kSame) return must("theta_deg", 0, joint.theta / kRadPerDegree);
  const bool has_d = i == 0 || i == 1 || i == 4;
  if (!has_d && std::abs(joint.d) > kSame) return must("d_m", 0, joint.d);
  if (i == 1 && std::abs(joint.a) > kSame) return must("a_m", 0, joint.a);
  if ((i == 0 || i == 2) && !(joint.a > kSame)) {
    return fmt::format("joint '{}': a_m must be positive, it is {:g}", joint.name, joint.a);
  }
  if (i != kParallelogram) {
    return joint.coupling ? fmt::format("joint '{}' is coupled", joint.name) : std::string{};
  }
  if (!joint.coupling)
    return fmt::format("joint '{}' is not coupled to the one before", joint.name);
  if (joint.coupling->to != kBalance || joint.coupling->ratio != -1 ||
      joint.coupling->offset != 0) {
    return fmt::format("joint '{}' must be coupled to the one before with ratio -1", joint.name);
  }
  return {};
}

}  // namespace

Expected<LampLengths> lamp_lengths(const RobotModel& model) {
  if (model.convention() != RobotModel::Convention::standard) {
    return refuse("not a lamp arm: its Denavit-Hartenberg convention is modified, not standard");
  }
  if (model.joint_count() != 6) {
    return refuse(fmt::format("not a lamp arm: 6 joints needed, '{}' has {}", model.name(),
                              model.joint_count()));
  }
  const auto& joints = model.joints();
  for (std::size_t i = 0; i < joints.size(); ++i) {
    if (auto why = joint_mismatch(joints[i], i); !why.empty()) {
      return refuse("not a lamp arm: " + why);
    }
  }
  if (!model.pointing_axis() || !model.pointing_axis()->isApprox(Eigen::Vector3d::UnitX(), kSame)) {
    return refuse("not a lamp arm: its pointing axis must be the tool's x");
  }
  const auto& tool = model.frame(model.tool());
  if (tool.parent_joint != 5 ||
      !tool.parent_T_frame.isApprox(Eigen::Isometry3d::Identity(), kSame)) {
    return refuse(
        fmt::format("not a lamp arm: its tool must be the frame of joint '{}'", joints[5].name));
  }
  return LampLengths{.a1 = joints[0].a,
                     .a3 = joints[2].a,
                     .a4 = joints[3].a,
                     .a5 = joints[4].a,
                     .a6 = joints[5].a,
                     .d = joints[0].d + joints[1].d + joints[4].d};
}

}  // namespace armature
