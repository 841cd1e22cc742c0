// SPDX-License-Identifier: Apache-2.0
#include "armature/kinds/ik/ik.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "armature/kinds/ik/farthest.hpp"
#include "armature/robot/kinematics/kinematics.hpp"

namespace armature {

std::string_view to_string(IkStatus::Code code) {
  switch (code) {
    case IkStatus::Code::ok: return "ok";
    case IkStatus::Code::out_of_reach: return "out_of_reach";
    case IkStatus::Code::joint_limit: return "joint_limit";
    case IkStatus::Code::singular: return "singular";
    case IkStatus::Code::no_convergence: return "no_convergence";
    case IkStatus::Code::invalid_input: return "invalid_input";
  }
  return "invalid_input";
}

namespace {

template <class Text>
Text text_of(const IkStatus& status) {
  const std::string_view code = to_string(status.code);
  if (status.code == IkStatus::Code::out_of_reach && status.shortfall > 0) {
    if (status.detail.empty()) {
      return Text::format("{}: {:.3g} m beyond reach", code, status.shortfall);
    }
    return Text::format("{}: {:.3g} m beyond reach ({})", code, status.shortfall, status.detail);
  }
  const char* const colon = status.detail.empty() ? "" : ": ";
  if (status.code == IkStatus::Code::no_convergence && status.shortfall > 0) {
    return Text::format("{}{}{} (residual {:.3g})", code, colon, status.detail, status.shortfall);
  }
  return Text::format("{}{}{}", code, colon, status.detail);
}

}  // namespace

ReasonText reason_of(const IkStatus& status) { return text_of<ReasonText>(status); }

std::string describe(const IkStatus& status) {
  return std::string{text_of<InlineText<4000>>(status).view()};
}

const char* invalid_input(const RobotModel& model, const IkGoal& goal, const JointVector& seed) {
  if (!goal.pose.position.allFinite()) return "the position is not finite";
  if (goal.pose.position.cwiseAbs().maxCoeff() > kFarthest) {
    return "the position is more than 1e100 m away";
  }
  if (const auto* direction = std::get_if<Direction>(&goal.pose.orientation)) {
    if (!direction->unit.allFinite()) return "the direction is not finite";
    if (!(direction->unit.norm() > 1e-9)) return "the direction is zero";
    if (!std::isfinite(direction->unit.norm())) return "the direction is longer than numbers go";
    if (!model.pointing_axis()) return "the robot has no pointing axis, so it needs a rotation";
  } else {
    const auto& rotation = std::get<Eigen::Quaterniond>(goal.pose.orientation);
    if (!rotation.coeffs().allFinite()) return "the rotation is not finite";
    if (!(rotation.norm() > 1e-9)) return "the rotation is a zero quaternion";
    if (!std::isfinite(rotation.norm())) return "the quaternion is longer than numbers go";
  }
  if (goal.redundancy && !std::isfinite(*goal.redundancy)) return "the redundancy is not finite";
  if (!(goal.tolerance.position_m > 0) || !(goal.tolerance.angle_rad > 0)) {
    return "the tolerance is not positive";
  }
  if (seed.size() != model.dof()) return "the seed has the wrong number of joints";
  if (!seed.allFinite()) return "the seed is not finite";
  return nullptr;
}

IkBranch branch_at(const RobotModel& model, const IkGoal& goal, const JointVector& q,
                   std::string_view label) {
  constexpr double kSingular = 1e-6;  // manipulability
  IkBranch branch;
  branch.label = label;
  branch.q = q;
  for (int i = 0; i < model.dof(); ++i) {
    if (turns_freely(model, i)) branch.q[i] = wrap_angle(q[i]);
  }
  JointVector turned = branch.q;
  branch.within_limits = unwind(model, branch.q, turned);
  branch.singular = manipulability(model, branch.q) < kSingular;
  const Eigen::Vector3d axis = model.pointing_axis().value_or(Eigen::Vector3d::UnitX());
  branch.residual = residual(forward_kinematics(model, branch.q), axis, goal.pose);
  return branch;
}

const IkBranch* nearest_branch(const IkBranches& branches, const JointVector& near,
                               const RobotModel& model) {
  const IkBranch* best = nullptr;
  double best_distance = 0;
  for (const IkBranch& branch : branches) {
    JointVector q = branch.q;
    if (!branch.within_limits || !unwind(model, near, q)) continue;
    const double distance = (q - near).squaredNorm();
    if (!best || distance < best_distance) {
      best = &branch;
      best_distance = distance;
    }
  }
  return best;
}

bool turns_freely(const RobotModel& model, int i) {
  for (const ChainLink& link : model.chain()) {
    if (link.independent != i || link.ratio == 0) continue;  // 0: it is locked
    if (link.prismatic || link.ratio != std::round(link.ratio)) return false;
  }
  return true;
}

bool unwind(const RobotModel& model, const JointVector& near, JointVector& q) {
  constexpr double kTurn = 2 * std::numbers::pi;
  constexpr double kTolerance = 1e-9;
  bool inside = true;
  for (int i = 0; i < model.dof(); ++i) {
    const double lower = model.lower()[i] - kTolerance, upper = model.upper()[i] + kTolerance;
    const bool within = q[i] >= lower && q[i] <= upper;
    if (within && std::abs(near[i] - q[i]) < std::numbers::pi) continue;  // as near as it gets
    if (!turns_freely(model, i)) {
      inside = inside && within;
      continue;
    }
    const double wanted = q[i] + kTurn * std::round((near[i] - q[i]) / kTurn);
    const double least = q[i] + kTurn * std::ceil((lower - q[i]) / kTurn);
    const double most = q[i] + kTurn * std::floor((upper - q[i]) / kTurn);
    inside = inside && least <= most;
    q[i] = least <= most ? std::clamp(wanted, least, most) : wanted;
  }
  return inside;
}

}  // namespace armature
