// SPDX-License-Identifier: Apache-2.0
#include "armature/robot/kinematics/locked_joints.hpp"

#include <algorithm>
#include <array>
#include <utility>

#include "armature/robot/kinematics/kinematics.hpp"

namespace armature {
namespace {

/// Where what hangs on a joint of the whole arm hangs on the arm without locked joints.
struct Seat {
  int joint = -1;
  Eigen::Isometry3d joint_T_old = Eigen::Isometry3d::Identity();
};

}  // namespace

RobotModel without_locked_joints(const RobotModel& model) {
  if (std::ranges::none_of(model.joints(), &Joint::locked)) return model;
  std::array<Eigen::Isometry3d, kMaxJoints> frames;
  joint_frames(model, resting_position(model), frames);

  RobotParts parts = model.parts();
  parts.joints.clear();
  std::vector<double> home;
  std::vector<Seat> seats{{}};  // of the base, then of every joint
  for (std::size_t i = 0; i < model.joints().size(); ++i) {
    const Seat& before = seats.back();
    if (model.joints()[i].locked) {
      const Eigen::Isometry3d step = i == 0 ? frames[i] : frames[i - 1].inverse() * frames[i];
      seats.push_back({before.joint, before.joint_T_old * step});
      continue;
    }
    Joint joint = model.joints()[i];
    if (i > 0 && model.joints()[i - 1].locked) {
      joint.placement =
          before.joint_T_old * joint.placement.value_or(Eigen::Isometry3d::Identity());
    }
    seats.push_back({static_cast<int>(parts.joints.size()), Eigen::Isometry3d::Identity()});
    parts.joints.push_back(std::move(joint));
    home.push_back((*model.home())[static_cast<Eigen::Index>(i)]);
  }
  const auto seat_of = [&](int old_joint) {
    return seats[static_cast<std::size_t>(old_joint + 1)];
  };

  for (Joint& joint : parts.joints) {
    if (joint.coupling) joint.coupling->to = seat_of(joint.coupling->to).joint;
  }
  for (NamedFrame& frame : parts.frames) {
    const Seat seat = seat_of(frame.parent_joint);
    frame = {frame.name, seat.joint, seat.joint_T_old * frame.parent_T_frame};
  }
  for (LinkCapsule& capsule : parts.capsules) {
    const Seat seat =
        seat_of(std::exchange(capsule.parent_joint, seat_of(capsule.parent_joint).joint));
    capsule.from = seat.joint_T_old * capsule.from;
    capsule.to = seat.joint_T_old * capsule.to;
  }
  for (LinkMass& mass : parts.masses) {
    const Seat seat = seat_of(std::exchange(mass.parent_joint, seat_of(mass.parent_joint).joint));
    mass.centre = seat.joint_T_old * mass.centre;
  }
  parts.home =
      Eigen::Map<const Eigen::VectorXd>{home.data(), static_cast<Eigen::Index>(home.size())};
  return parts;
}

}  // namespace armature
