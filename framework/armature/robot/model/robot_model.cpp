// SPDX-License-Identifier: Apache-2.0
#include "armature/robot/model/robot_model.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <stdexcept>

namespace armature {
namespace {

// [rad] or [m]
constexpr double kCouplingTolerance = 1e-6;
constexpr double kLockTolerance = 1e-4;  // what a sensor may tell of a joint that stands still

void require(bool condition, const std::string& message) {
  if (!condition) throw std::invalid_argument(message);
}

/// An interval of a joint's value, or of its speed with lower = -upper.
struct Range {
  double lower, upper;
};

/// The leader's values for which ratio * q + offset stays in `range`.
Range leader_range(Range range, const Joint::Coupling& coupling) {
  const double a = (range.lower - coupling.offset) / coupling.ratio;
  const double b = (range.upper - coupling.offset) / coupling.ratio;
  return {std::min(a, b), std::max(a, b)};
}

ChainLink link_of(const Joint& joint) {
  ChainLink link;
  link.prismatic = joint.type == Joint::Type::prismatic;
  link.theta = joint.theta;
  link.d = joint.d;
  link.a = joint.a;
  // A quarter turn is exact: cos(pi/2) is 6e-17 in double and would tilt every axis behind it.
  const double quarters = joint.alpha / (0.5 * std::numbers::pi);
  const bool exact = std::abs(quarters - std::round(quarters)) < 1e-14;
  link.cos_alpha = exact ? std::round(std::cos(joint.alpha)) : std::cos(joint.alpha);
  link.sin_alpha = exact ? std::round(std::sin(joint.alpha)) : std::sin(joint.alpha);
  link.placement = joint.placement.value_or(Eigen::Isometry3d::Identity());
  return link;
}

}  // namespace

RobotModel::RobotModel(RobotParts parts) : parts_{std::move(parts)} {
  require(!joints().empty() && joint_count() <= kMaxJoints,
          fmt::format("a robot has 1 to {} joints, not {}", kMaxJoints, joint_count()));
  const int tool = static_cast<int>(parts_.tool), frame_count = static_cast<int>(frames().size());
  require(tool >= 0 && tool < frame_count,
          fmt::format("frame {} is not one of {} frames", tool, frame_count));
  const auto require_parents = [&](const char* what, const auto& all) {
    for (const auto& each : all) {
      require(each.parent_joint >= -1 && each.parent_joint < joint_count(),
              fmt::format("{} {}: joint {} is not there", what, each.name, each.parent_joint));
    }
  };
  require_parents("frame", frames());
  require_parents("capsule", capsules());
  require_parents("mass", masses());
  for (const Joint& joint : joints()) {
    require(joint.lower <= joint.upper,
            fmt::format("joint {}: its lower limit {:g} is above its upper limit {:g}", joint.name,
                        joint.lower, joint.upper));
  }
  require(!home() || home()->size() == joint_count(), "home needs a value for every joint");
  if (parts_.pointing_axis) parts_.pointing_axis->normalize();
  if (parts_.shaft) parts_.shaft->axis.normalize();
  number_joints();
  fold_limits();
}

void RobotModel::number_joints() {
  std::vector<int> place(joints().size(), -1);  // among the independent joints
  for (std::size_t i = 0; i < joints().size(); ++i) {
    const Joint& joint = joints()[i];
    if (joint.coupling || joint.locked) continue;
    place[i] = dof();
    independent_.push_back(static_cast<int>(i));
  }
  require(dof() > 0, "a robot needs a joint that moves by itself");
  for (std::size_t i = 0; i < joints().size(); ++i) {
    ChainLink link = link_of(joints()[i]);
    link.independent = place[i];
    if (joints()[i].locked) {
      require(home().has_value(),
              fmt::format("joint {} is locked at home, and there is none", joints()[i].name));
      link.independent = 0;
      link.ratio = 0;
      link.offset = (*home())[static_cast<Eigen::Index>(i)];
    } else if (const auto& coupling = joints()[i].coupling) {
      require(coupling->to >= 0 && coupling->to < joint_count() &&
                  place[static_cast<std::size_t>(coupling->to)] >= 0 && coupling->ratio != 0,
              fmt::format("joint {} must be coupled to an independent joint, with a ratio other "
                          "than 0",
                          joints()[i].name));
      link.independent = place[static_cast<std::size_t>(coupling->to)];
      link.ratio = coupling->ratio;
      link.offset = coupling->offset;
    }
    chain_.push_back(link);
    is_placed_ = is_placed_ || joints()[i].placement;
  }
}

void RobotModel::fold_limits() {
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  lower_ = JointVector::Constant(dof(), -kInfinity);
  upper_ = JointVector::Constant(dof(), kInfinity);
  max_velocity_ = max_acceleration_ = upper_;
  for (std::size_t i = 0; i < joints().size(); ++i) {
    const Joint& joint = joints()[i];
    if (joint.locked) continue;
    const int k = chain_[i].independent;
    const auto range = leader_range({joint.lower, joint.upper},
                                    {.ratio = chain_[i].ratio, .offset = chain_[i].offset});
    const double gear = std::abs(chain_[i].ratio);
    lower_[k] = std::max(lower_[k], range.lower);
    upper_[k] = std::min(upper_[k], range.upper);
    max_velocity_[k] = std::min(max_velocity_[k], joint.max_velocity / gear);
    max_acceleration_[k] = std::min(max_acceleration_[k], joint.max_acceleration / gear);
  }
}

std::optional<FrameId> RobotModel::find_frame(std::string_view name) const {
  const auto found = std::ranges::find(frames(), name, &NamedFrame::name);
  if (found == frames().end()) return std::nullopt;
  return FrameId{static_cast<int>(found - frames().begin())};
}

JointVector RobotModel::to_all(const JointVector& independent) const {
  JointVector all(joint_count());
  for (int i = 0; i < joint_count(); ++i) {
    const ChainLink& link = chain_[static_cast<std::size_t>(i)];
    all[i] = link.ratio * independent[link.independent] + link.offset;
  }
  return all;
}

namespace {

Expected<JointVector> expected(const ReasonText& wrong, const JointVector& independent) {
  if (wrong.empty()) return independent;
  return refuse(std::string{wrong.view()});
}

}  // namespace

Expected<JointVector> RobotModel::to_independent(const JointVector& all) const {
  return to_independent(std::span<const double>{all.data(), static_cast<std::size_t>(all.size())});
}

Expected<JointVector> RobotModel::to_independent(std::span<const double> all) const {
  JointVector independent;
  const ReasonText wrong = to_independent(all, independent);
  return expected(wrong, independent);
}

Expected<JointVector> RobotModel::contract_rates(std::span<const double> all) const {
  JointVector independent;
  const ReasonText wrong = contract_rates(all, independent);
  return expected(wrong, independent);
}

ReasonText RobotModel::to_independent(std::span<const double> all, JointVector& independent) const {
  return contracted(all, 1, independent);
}

ReasonText RobotModel::contract_rates(std::span<const double> all, JointVector& independent) const {
  return contracted(all, 0, independent);
}

ReasonText RobotModel::contracted(std::span<const double> all, double offset_factor,
                                  JointVector& independent) const {
  if (all.size() != joints().size())
    return ReasonText::format("{} joint values; {} has {} joints", all.size(), name(),
                              joint_count());
  for (std::size_t i = 0; i < all.size(); ++i)
    if (!std::isfinite(all[i]))
      return ReasonText::format("{} = {} is not a number", joints()[i].name, all[i]);
  independent.resize(dof());
  for (int i = 0; i < dof(); ++i) {
    independent[i] = all[static_cast<std::size_t>(independent_joint(i))];
  }
  for (std::size_t i = 0; i < all.size(); ++i) {
    const ChainLink& link = chain_[i];
    const Joint& joint = joints()[i];
    if (joint.locked) {
      const bool moved = std::abs(all[i] - link.offset) > kLockTolerance;
      if (offset_factor == 0 || !moved) continue;
      return ReasonText::format("{} = {:.6g}, and it is locked at {:.6g}", joint.name, all[i],
                                link.offset);
    }
    const double follows = link.ratio * independent[link.independent] + offset_factor * link.offset;
    const bool is_measured = joint.coupling && joint.coupling->within;
    if (is_measured && offset_factor == 0) continue;
    if (std::abs(all[i] - follows) > (is_measured ? *joint.coupling->within : kCouplingTolerance))
      return ReasonText::format(
          "{} = {:.6g} contradicts its coupling to {}, which makes it {:.6g}", joint.name, all[i],
          joints()[static_cast<std::size_t>(joint.coupling->to)].name, follows);
  }
  return {};
}

bool RobotModel::within_limits(const JointVector& independent, double tolerance) const {
  for (int i = 0; i < dof(); ++i)
    if (!(independent[i] >= lower_[i] - tolerance && independent[i] <= upper_[i] + tolerance))
      return false;
  return true;
}

bool RobotModel::is_revolute(int i) const {
  return joints()[static_cast<std::size_t>(independent_joint(i))].type == Joint::Type::revolute;
}

JointVector resting_position(const RobotModel& model) {
  if (model.home()) {
    if (auto home = model.to_independent(*model.home())) return *home;
  }
  JointVector middle = 0.5 * (model.lower() + model.upper());
  for (int i = 0; i < model.dof(); ++i) {
    if (!std::isfinite(middle[i]))
      middle[i] = std::min(std::max(0.0, model.lower()[i]), model.upper()[i]);
  }
  return middle;
}

}  // namespace armature
