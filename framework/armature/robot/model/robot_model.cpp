// SPDX-License-Identifier: Apache-2.0
#include "armature/robot/model/robot_model.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <stdexcept>

namespace armature {
namespace {

constexpr double kCouplingTolerance = 1e-6;  // [rad] or [m]

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

RobotModel::RobotModel(std::string name, Convention convention, std::vector<Joint> joints,
                       std::vector<NamedFrame> frames, FrameId tool,
                       std::optional<Eigen::Vector3d> pointing_axis,
                       std::optional<JointVector> home_all, std::optional<Shaft> shaft,
                       std::vector<LinkCapsule> capsules)
    : name_(std::move(name)),
      convention_(convention),
      joints_(std::move(joints)),
      frames_(std::move(frames)),
      tool_(tool),
      pointing_axis_(std::move(pointing_axis)),
      home_(std::move(home_all)),
      shaft_(std::move(shaft)),
      capsules_(std::move(capsules)) {
  require(!joints_.empty() && joint_count() <= kMaxJoints,
          fmt::format("a robot has 1 to {} joints, not {}", kMaxJoints, joint_count()));
  const int frame_count = static_cast<int>(frames_.size());
  require(static_cast<int>(tool_) >= 0 && static_cast<int>(tool_) < frame_count,
          fmt::format("frame {} is not one of {} frames", static_cast<int>(tool_), frame_count));
  for (const NamedFrame& frame : frames_)
    require(frame.parent_joint >= -1 && frame.parent_joint < joint_count(),
            fmt::format("frame {}: joint {} is not there", frame.name, frame.parent_joint));
  for (const LinkCapsule& capsule : capsules_)
    require(capsule.parent_joint >= -1 && capsule.parent_joint < joint_count(),
            fmt::format("capsule {}: joint {} is not there", capsule.name, capsule.parent_joint));
  require(!home_ || home_->size() == joint_count(), "home needs a value for every joint");
  if (pointing_axis_) pointing_axis_->normalize();
  if (shaft_) shaft_->axis.normalize();
  number_joints();
  fold_limits();
}

void RobotModel::number_joints() {
  std::vector<int> place(joints_.size(), -1);  // among the independent joints
  for (std::size_t i = 0; i < joints_.size(); ++i) {
    if (joints_[i].coupling) continue;
    place[i] = dof();
    independent_.push_back(static_cast<int>(i));
  }
  for (std::size_t i = 0; i < joints_.size(); ++i) {
    ChainLink link = link_of(joints_[i]);
    link.independent = place[i];
    if (const auto& coupling = joints_[i].coupling) {
      require(coupling->to >= 0 && coupling->to < joint_count() &&
                  place[static_cast<std::size_t>(coupling->to)] >= 0 && coupling->ratio != 0,
              fmt::format("joint {} must be coupled to an independent joint, with a ratio other "
                          "than 0",
                          joints_[i].name));
      link.independent = place[static_cast<std::size_t>(coupling->to)];
      link.ratio = coupling->ratio;
      link.offset = coupling->offset;
    }
    chain_.push_back(link);
    is_placed_ = is_placed_ || joints_[i].placement;
  }
}

void RobotModel::fold_limits() {
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  lower_ = JointVector::Constant(dof(), -kInfinity);
  upper_ = JointVector::Constant(dof(), kInfinity);
  max_velocity_ = max_acceleration_ = upper_;
  for (std::size_t i = 0; i < joints_.size(); ++i) {
    const Joint& joint = joints_[i];
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
  const auto found = std::ranges::find(frames_, name, &NamedFrame::name);
  if (found == frames_.end()) return std::nullopt;
  return FrameId{static_cast<int>(found - frames_.begin())};
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
  if (all.size() != joints_.size())
    return ReasonText::format("{} joint values; {} has {} joints", all.size(), name_,
                              joint_count());
  for (std::size_t i = 0; i < all.size(); ++i)
    if (!std::isfinite(all[i]))
      return ReasonText::format("{} = {} is not a number", joints_[i].name, all[i]);
  independent.resize(dof());
  for (int i = 0; i < dof(); ++i) {
    independent[i] = all[static_cast<std::size_t>(independent_joint(i))];
  }
  for (std::size_t i = 0; i < all.size(); ++i) {
    const ChainLink& link = chain_[i];
    const double follows = link.ratio * independent[link.independent] + offset_factor * link.offset;
    if (std::abs(all[i] - follows) > kCouplingTolerance)
      return ReasonText::format(
          "{} = {:.6g} contradicts its coupling to {}, which makes it {:.6g}", joints_[i].name,
          all[i], joints_[static_cast<std::size_t>(joints_[i].coupling->to)].name, follows);
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
  return joints_[static_cast<std::size_t>(independent_joint(i))].type == Joint::Type::revolute;
}

JointVector resting_position(const RobotModel& model) {
  if (model.home()) {
    if (auto home = model.to_independent(*model.home())) return *home;
  }
  JointVector middle = 0.5 * (model.lower() + model.upper());
  for (double& q : middle) {
    if (!std::isfinite(q)) q = 0;
  }
  return middle;
}

}  // namespace armature
