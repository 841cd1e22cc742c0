// SPDX-License-Identifier: Apache-2.0
#include "frame_tree.hpp"

#include <array>
#include <set>

#include "armature/kinds/geometry_params.hpp"
#include "armature/messages/geometry.hpp"
#include "armature/messages/header.hpp"
#include "armature/robot/kinematics/kinematics.hpp"

namespace armature::monitor::rviz {
namespace {

void write_edge(const std::string& parent, const std::string& child,
                const Eigen::Isometry3d& parent_T_child, Time stamp,
                msg::TransformStamped& message) {
  write_header(message.header_(), stamp, parent);
  message.child_frame_id_() = child;
  assign(message.transform_(), parent_T_child);
}

}  // namespace

JointPlace joint_place(const RobotModel& model, int joint) {
  const ChainLink& link = model.chain()[static_cast<std::size_t>(joint)];
  Eigen::Isometry3d screw = Eigen::Isometry3d::Identity(), bend = screw;  // along z, along x
  screw.linear() = Eigen::AngleAxisd{link.theta, Eigen::Vector3d::UnitZ()}.toRotationMatrix();
  screw.translation().z() = link.d;
  bend.linear() << 1, 0, 0, 0, link.cos_alpha, -link.sin_alpha, 0, link.sin_alpha, link.cos_alpha;
  bend.translation().x() = link.a;
  if (model.convention() == RobotModel::Convention::modified) {
    return {link.placement * bend * screw, Eigen::Vector3d::UnitZ(), {}};
  }
  // The axis goes through the joint's own origin too when that is not moved away from it.
  if (link.prismatic || link.a == 0) {
    return {link.placement * screw * bend, {0, link.sin_alpha, link.cos_alpha}, {}};
  }
  return {link.placement * screw, Eigen::Vector3d::UnitZ(), bend};
}

Expected<FrameTree> FrameTree::make(const RobotModel& model, const std::optional<StereoRig>& rig,
                                    const Parameters& parameters) {
  FrameTree tree{model, parameters};
  tree.add_fixed(rig);
  if (const auto sound = tree.check_names(); !sound) return tl::unexpected{sound.error()};
  return tree;
}

void FrameTree::add_fixed(const std::optional<StereoRig>& rig) {
  if (!parameters_.world_frame.empty()) {
    fixed_.push_back({parameters_.world_frame, name(kBaseFrame),
                      pose_of(parameters_.base_position, parameters_.base_rpy)});
  }
  for (const NamedFrame& frame : model_->frames()) {
    fixed_.push_back({joint_frame(frame.parent_joint), name(frame.name), frame.parent_T_frame});
  }
  if (!rig) return;
  Eigen::Isometry3d left_T_right = Eigen::Isometry3d::Identity();
  left_T_right.translation().x() = rig->camera.baseline_m;
  fixed_.push_back({name(rig->mounted_on), name(kLeftCameraFrame), rig->mount_T_left});
  fixed_.push_back({name(kLeftCameraFrame), name(kRightCameraFrame), left_T_right});
}

Expected<void> FrameTree::check_names() const {
  for (const std::string& given : {parameters_.frame_prefix, parameters_.world_frame}) {
    if (given.starts_with('/')) {
      return refuse("'" + given + "' begins with '/', which no tf2 frame may");
    }
  }
  std::set<std::string> taken{parameters_.world_frame.empty() ? name(kBaseFrame)
                                                              : parameters_.world_frame};
  const auto take = [&](const std::string& child) -> Expected<void> {
    if (taken.insert(child).second) return {};
    return refuse("two frames would be called '" + child + "'");
  };
  for (int joint = 0; joint < model_->joint_count(); ++joint) {
    if (const auto taking = take(joint_frame(joint)); !taking) return taking;
    if (!joint_place(*model_, joint).moved_T_joint) continue;
    if (const auto taking = take(moved_frame(joint)); !taking) return taking;
  }
  for (const Edge& edge : fixed_) {
    if (const auto taking = take(edge.child); !taking) return taking;
  }
  return {};
}

std::string FrameTree::joint_frame(int joint) const {
  if (joint < 0) return name(kBaseFrame);
  // URDF has names of joints and names of links: the frame that both would have is the link's.
  const std::string& own = model_->joints()[static_cast<std::size_t>(joint)].name;
  return name(model_->find_frame(own) ? own + "_axis" : own);
}

void FrameTree::write_moving(const JointVector& q, Time stamp, msg::TFMessage& message) const {
  std::array<Eigen::Isometry3d, kMaxJoints> base_T_joint;
  joint_frames(*model_, q, base_T_joint);
  const auto count = static_cast<std::size_t>(model_->joint_count());
  message.transforms_().resize(count);
  Eigen::Isometry3d base_T_parent = Eigen::Isometry3d::Identity();
  for (std::size_t i = 0; i < count; ++i) {
    const int joint = static_cast<int>(i);
    write_edge(joint_frame(joint - 1), joint_frame(joint),
               base_T_parent.inverse() * base_T_joint[i], stamp, message.transforms_()[i]);
    base_T_parent = base_T_joint[i];
  }
}

void FrameTree::write_fixed(Time stamp, msg::TFMessage& message) const {
  message.transforms_().clear();
  const auto add = [&](const Edge& edge) {
    message.transforms_().emplace_back();
    write_edge(edge.parent, edge.child, edge.parent_T_child, stamp, message.transforms_().back());
  };
  for (const Edge& edge : fixed_) add(edge);
  for (int joint = 0; joint < model_->joint_count(); ++joint) {
    const auto moved_T_joint = joint_place(*model_, joint).moved_T_joint;
    if (moved_T_joint) add({joint_frame(joint), moved_frame(joint), moved_T_joint->inverse()});
  }
}

}  // namespace armature::monitor::rviz
