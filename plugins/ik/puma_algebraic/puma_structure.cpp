// SPDX-License-Identifier: Apache-2.0
#include "puma_structure.hpp"

#include <fmt/format.h>

#include <array>
#include <cmath>
#include <numbers>
#include <string>

#include "armature/values/angles.hpp"

namespace armature {
namespace {

constexpr double kPi = std::numbers::pi;
constexpr double kSame = 1e-9;  // [m] or [rad]

/// Tx(a) Rx(alpha) between two joints, and the joint in whose row of the file it stands.
struct Link {
  double a = 0, alpha = 0;
  const Joint* row = nullptr;

  Eigen::Isometry3d transform() const {
    return Eigen::Translation3d{a, 0, 0} * Eigen::AngleAxisd{alpha, Eigen::Vector3d::UnitX()};
  }
};

/// Both conventions are link 0, joint 1, link 1, joint 2, ... joint 6, link 6; a modified row i
/// states link i - 1, a standard row link i.
std::array<Link, 7> links_of(const RobotModel& model) {
  std::array<Link, 7> links;
  const bool modified = model.convention() == RobotModel::Convention::modified;
  for (std::size_t i = 0; i < 6; ++i) {
    const Joint& row = model.joints()[i];
    links[modified ? i : i + 1] = {row.a, row.alpha, &row};
  }
  return links;
}

bool is_angle(double angle, double wanted) { return std::abs(wrap_angle(angle - wanted)) < kSame; }

/// Why link `i`, between joints i and i + 1, is not the pattern's; empty when it is.
std::string link_mismatch(const Link& link, std::size_t i) {
  const bool parallel = i == 2;
  const double first = parallel ? 0 : kPi / 2, second = parallel ? kPi : -kPi / 2;
  if (!is_angle(link.alpha, first) && !is_angle(link.alpha, second))
    return fmt::format("alpha_deg must be {}, it is {:.10g}", parallel ? "0 or 180" : "90 or -90",
                       link.alpha / kRadPerDegree);
  if (parallel && !(std::abs(link.a) > kSame)) return "a_m must not be 0";
  if (i >= 4 && std::abs(link.a) > kSame)
    return fmt::format("a_m must be 0 for axes 4, 5 and 6 to meet, it is {:g}", link.a);
  return {};
}

/// Why joint `i` (from 0) is not the pattern's, as "joint 'j3'" + "..."; empty when it is.
std::string joint_mismatch(const Joint& joint, std::size_t i) {
  if (joint.coupling) return " is coupled";
  if (joint.locked) return " is locked";
  // The first one's is where the arm stands.
  if (i > 0 && joint.placement) return " is placed beside its row";
  if (i < 5 && joint.type != Joint::Type::revolute) return " is not revolute";
  if (i == 4 && std::abs(joint.d) > kSame)
    return fmt::format(": d_m must be 0 for axes 4, 5 and 6 to meet, it is {:g}", joint.d);
  const bool limited = std::isfinite(joint.lower) && std::isfinite(joint.upper);
  if (joint.type == Joint::Type::prismatic && !limited) return ", the needle, has no limits";
  return {};
}

std::string mismatch(const RobotModel& model) {
  if (model.joint_count() != 6)
    return fmt::format("6 joints needed, '{}' has {}", model.name(), model.joint_count());
  for (std::size_t i = 0; i < 6; ++i) {
    const Joint& joint = model.joints()[i];
    const std::string why = joint_mismatch(joint, i);
    if (!why.empty()) return fmt::format("joint '{}'{}", joint.name, why);
  }
  const auto links = links_of(model);
  for (std::size_t i = 1; i < 6; ++i) {
    const std::string why = link_mismatch(links[i], i);
    if (!why.empty()) return fmt::format("joint '{}': {}", links[i].row->name, why);
  }
  const Joint& fourth = model.joints()[3];
  if (!(std::hypot(links[3].a, fourth.d) > kSame))
    return fmt::format("joint '{}': d_m must not be 0 when the length before it is 0", fourth.name);
  if (model.frame(model.tool()).parent_joint != 5)
    return fmt::format("its tool must hang on joint '{}'", model.joints()[5].name);
  return {};
}

/// Joints whose axis points against the pattern's: Z(t, d) = Rx(180) Z(-t, -d) Rx(180) turns one
/// round, and the half turns go into the twists of the links on either side.
std::array<bool, 6> turned_joints(const std::array<Link, 7>& links) {
  constexpr std::array<double, 6> kTwist{0, -kPi / 2, 0, -kPi / 2, kPi / 2, -kPi / 2};
  std::array<bool, 6> turned{};
  for (std::size_t i = 1; i < 6; ++i) {
    const double wanted = kTwist[i] + (turned[i - 1] ? kPi : 0);
    turned[i] = !is_angle(links[i].alpha, wanted);
  }
  return turned;
}

/// Whether pointing goals say enough: 1 or -1 as in PumaArm::pointing.
std::optional<double> pointing_of(const RobotModel& model, const Eigen::Isometry3d& wrist_T_tool) {
  if (!model.pointing_axis()) return std::nullopt;
  const Eigen::Vector3d axis = wrist_T_tool.linear() * *model.pointing_axis();
  const bool along = axis.head<2>().norm() < kSame;
  const bool on_axis = wrist_T_tool.translation().head<2>().norm() < kSame;
  if (!along || !on_axis) return std::nullopt;
  return axis.z() > 0 ? 1.0 : -1.0;
}

void set_limits(const RobotModel& model, PumaArm& arm) {
  for (int i = 0; i < 6; ++i) {
    const double middle = 0.5 * (model.lower()[i] + model.upper()[i]);
    arm.half[i] = 0.5 * (model.upper()[i] - model.lower()[i]);
    // Without a limit on one side a joint that turns is never beyond the other.
    arm.middle[i] = !std::isfinite(middle) ? 0 : i == 5 && arm.needle ? middle : wrap_angle(middle);
  }
}

void set_places(PumaArm& arm) {
  using Rows = Eigen::Matrix<double, 3, 3, Eigen::RowMajor>;
  using Eigen::Map, Eigen::Vector3d;
  Map<Rows>{arm.shoulder_R_base[0]} = arm.base_T_shoulder.linear().transpose();
  Map<Vector3d>{arm.base_t_shoulder} = arm.base_T_shoulder.translation();
  Map<Rows>{arm.tool_R_wrist[0]} = arm.wrist_T_tool.linear().transpose();
  Map<Vector3d>{arm.wrist_t_tool} = arm.wrist_T_tool.translation();
}

}  // namespace

Expected<PumaArm> puma_arm(const RobotModel& model) {
  if (auto why = mismatch(model); !why.empty()) return refuse("not a PUMA-pattern arm: " + why);
  const auto& joints = model.joints();
  const auto links = links_of(model);
  const auto turned = turned_joints(links);
  const auto d = [&](std::size_t i) { return turned[i] ? -joints[i].d : joints[i].d; };

  PumaArm arm;
  arm.a1 = links[1].a;
  arm.d2 = d(1) + d(2);  // axes 2 and 3 are parallel
  arm.a2 = std::abs(links[2].a);
  arm.a3 = links[3].a;
  arm.d4 = d(3);
  arm.forearm = std::hypot(arm.a3, arm.d4);
  arm.beta = std::atan2(arm.d4, arm.a3);
  arm.cos_beta = arm.a3 / arm.forearm;
  arm.sin_beta = arm.d4 / arm.forearm;

  // Tx(a2) with a2 < 0 is Rz(180) Tx(-a2) Rz(-180).
  const double half = links[2].a < 0 ? kPi : 0;
  const std::array<double, 6> extra{0, half, -half, 0, 0, 0};
  for (std::size_t i = 0; i < 6; ++i) {
    arm.sign[i] = turned[i] ? -1 : 1;
    arm.zero[i] = wrap_angle(arm.sign[i] * extra[i] + joints[i].theta);
  }
  arm.base_T_shoulder = joints[0].placement.value_or(Eigen::Isometry3d::Identity()) *
                        links[0].transform() * Eigen::Translation3d{0, 0, joints[0].d};
  arm.wrist_T_tool = Eigen::Translation3d{0, 0, d(5)} * Link{0, turned[5] ? kPi : 0}.transform() *
                     links[6].transform() * model.frame(model.tool()).parent_T_frame;
  arm.needle = joints[5].type == Joint::Type::prismatic;
  if (arm.needle) {  // its fixed angle belongs to the tool
    arm.wrist_T_tool =
        Eigen::AngleAxisd{arm.sign[5] * arm.zero[5], Eigen::Vector3d::UnitZ()} * arm.wrist_T_tool;
    arm.zero[5] = 0;
  }
  arm.pointing = pointing_of(model, arm.wrist_T_tool);
  set_limits(model, arm);
  set_places(arm);
  return arm;
}

}  // namespace armature
