// SPDX-License-Identifier: Apache-2.0
#include "srs_structure.hpp"

#include <fmt/format.h>

#include <cmath>
#include <numbers>
#include <string>

#include "armature/values/angles.hpp"

namespace armature {
namespace {

constexpr double kSame = 1e-9;  // [m] or [rad]
constexpr std::size_t kJoints = 7;

/// Tx(a) Rx(alpha) between two joints, and the joint in whose row of the file it stands.
struct Link {
  double a = 0, alpha = 0;
  const Joint* row = nullptr;

  Eigen::Isometry3d transform() const {
    return Eigen::Translation3d{a, 0, 0} * Eigen::AngleAxisd{alpha, Eigen::Vector3d::UnitX()};
  }
};
using Links = std::array<Link, kJoints + 1>;

/// Both conventions are link 0, joint 1, link 1, joint 2, ... joint 7, link 7; a modified row i
/// states link i - 1, a standard row link i.
Links links_of(const RobotModel& model) {
  Links links;
  const bool modified = model.convention() == RobotModel::Convention::modified;
  for (std::size_t i = 0; i < kJoints; ++i) {
    const Joint& row = model.joints()[i];
    links[modified ? i : i + 1] = {row.a, row.alpha, &row};
  }
  return links;
}

bool is_angle(double angle, double wanted) { return std::abs(wrap_angle(angle - wanted)) < kSame; }

/// Why the link between two joints is not the pattern's; empty when it is.
std::string link_mismatch(const Link& link) {
  if (!is_angle(link.alpha, std::numbers::pi / 2) && !is_angle(link.alpha, -std::numbers::pi / 2))
    return fmt::format("joint '{}': alpha_deg must be 90 or -90, it is {:.10g}", link.row->name,
                       link.alpha / kRadPerDegree);
  if (std::abs(link.a) > kSame)
    return fmt::format("joint '{}': a_m must be 0, it is {:g}", link.row->name, link.a);
  return {};
}

/// Why joint `i` (from 0) is not the pattern's; empty when it is.
std::string joint_mismatch(const Joint& joint, std::size_t i) {
  if (joint.coupling) return fmt::format("joint '{}' is coupled", joint.name);
  if (joint.locked) return fmt::format("joint '{}' is locked", joint.name);
  if (i > 0 && joint.placement)  // the first one's is where the arm stands
    return fmt::format("joint '{}' is placed beside its row", joint.name);
  if (joint.type != Joint::Type::revolute)
    return fmt::format("joint '{}' is not revolute", joint.name);
  const bool meets = i == 1 || i == 3 || i == 5;  // the axes on either side
  if (meets && std::abs(joint.d) > kSame)
    return fmt::format("joint '{}': d_m must be 0, it is {:g}", joint.name, joint.d);
  if ((i == 2 || i == 4) && !(std::abs(joint.d) > kSame))
    return fmt::format("joint '{}': d_m must not be 0", joint.name);
  return {};
}

std::string mismatch(const RobotModel& model) {
  if (model.joint_count() != static_cast<int>(kJoints))
    return fmt::format("7 joints needed, '{}' has {}", model.name(), model.joint_count());
  for (std::size_t i = 0; i < kJoints; ++i)
    if (auto why = joint_mismatch(model.joints()[i], i); !why.empty()) return why;
  const Links links = links_of(model);
  for (std::size_t i = 1; i < kJoints; ++i)
    if (auto why = link_mismatch(links[i]); !why.empty()) return why;
  if (model.frame(model.tool()).parent_joint != 6)
    return fmt::format("its tool must hang on joint '{}'", model.joints()[6].name);
  if (model.pointing_axis())
    return "it has a pointing axis, and the turn about it would be a second redundancy";
  return {};
}

/// Joints whose axis points against the pattern's: Z(t, d) = Rx(180) Z(-t, -d) Rx(180) turns one
/// round, and the half turns go into the twists of the links on either side.
std::array<bool, kJoints> turned_joints(const Links& links) {
  constexpr double kQuarter = std::numbers::pi / 2;
  constexpr std::array<double, kJoints> kTwist{0,         -kQuarter, kQuarter, kQuarter,
                                               -kQuarter, -kQuarter, kQuarter};
  std::array<bool, kJoints> turned{};
  for (std::size_t i = 1; i < kJoints; ++i) {
    const double wanted = kTwist[i] + (turned[i - 1] ? std::numbers::pi : 0);
    turned[i] = !is_angle(links[i].alpha, wanted);
  }
  return turned;
}

/// Tz(d) with d < 0 is Ry(180) Tz(-d) Ry(-180): joint `i` turns round, its neighbours take half
/// turns.
void make_positive(SrsArm& arm, double& length, std::size_t i) {
  if (length > 0) return;
  length = -length;
  arm.sign[i] = -arm.sign[i];
  arm.offset[i] = -arm.offset[i];
  arm.offset[i - 1] += std::numbers::pi;
  arm.offset[i + 1] += std::numbers::pi;
}

void set_limits(const RobotModel& model, SrsArm& arm) {
  for (std::size_t i = 0; i < kJoints; ++i) {
    const auto at = static_cast<int>(i);
    const double middle = 0.5 * (model.lower()[at] + model.upper()[at]);
    // Without a limit on one side a joint that turns is never beyond the other.
    arm.half[i] = 0.5 * (model.upper()[at] - model.lower()[at]);
    arm.middle[i] = std::isfinite(middle) ? arm.canonical(i, middle) : 0;
  }
}

}  // namespace

Expected<SrsArm> srs_arm(const RobotModel& model) {
  if (auto why = mismatch(model); !why.empty()) return refuse("not an S-R-S arm: " + why);
  const auto& joints = model.joints();
  const Links links = links_of(model);
  const auto turned = turned_joints(links);
  const auto d = [&](std::size_t i) { return turned[i] ? -joints[i].d : joints[i].d; };

  SrsArm arm;
  for (std::size_t i = 0; i < kJoints; ++i) {
    arm.sign[i] = turned[i] ? -1 : 1;
    arm.offset[i] = arm.sign[i] * joints[i].theta;
  }
  arm.upper = d(2);
  arm.fore = d(4);
  make_positive(arm, arm.upper, 2);
  make_positive(arm, arm.fore, 4);
  for (double& offset : arm.offset) offset = wrap_angle(offset);
  set_limits(model, arm);
  arm.base_T_shoulder = joints[0].placement.value_or(Eigen::Isometry3d::Identity()) *
                        links[0].transform() * Eigen::Translation3d{0, 0, joints[0].d};
  arm.wrist_T_tool = Eigen::Translation3d{0, 0, d(6)} *
                     Link{0, turned[6] ? std::numbers::pi : 0}.transform() * links[7].transform() *
                     model.frame(model.tool()).parent_T_frame;
  return arm;
}

}  // namespace armature
