// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Geometry>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "armature/messages/tf2_msgs.hpp"
#include "armature/robot/files/stereo_rig.hpp"
#include "armature/robot/model/robot_model.hpp"
#include "armature/values/time.hpp"
#include "monitor_rviz_parameters.hpp"

namespace armature::monitor::rviz {

/// A joint's row as URDF can say it: a constant, the motion about or along an axis through the
/// origin that it leads to, and a constant.
struct JointPlace {
  Eigen::Isometry3d before_T_moved;                // with the joint at 0
  Eigen::Vector3d axis;                            // unit, in the moved frame
  std::optional<Eigen::Isometry3d> moved_T_joint;  // none: they are the same
};
JointPlace joint_place(const RobotModel& model, int joint);

/// The robot's frames as tf2 has them. Every joint's frame hangs on the one before it, the first on
/// `base`; a named frame on its joint (or base); the cameras on the frame that the rig is mounted
/// on. Names are those of the robot file, so they equal the frame_id of the other topics.
class FrameTree {
 public:
  /// `model` must outlive it. Refuses names that tf2 does not take or that two frames would have.
  static Expected<FrameTree> make(const RobotModel& model, const std::optional<StereoRig>& rig,
                                  const Parameters& parameters);

  /// How tf calls a frame of the robot: "base" -> "left/base".
  std::string name(std::string_view frame) const {
    return parameters_.frame_prefix + std::string{frame};
  }
  /// The frame of a joint; -1: base. Called as the joint, with "_axis" behind it when a named frame
  /// (a link of a URDF file) is called so.
  std::string joint_frame(int joint) const;

  /// Where a joint has moved, in front of the rest of its row, when its place has such a frame:
  /// its axis goes through the origin there. Hangs on the joint's frame.
  std::string moved_frame(int joint) const { return joint_frame(joint) + "_moved"; }

  /// A frame that does not move against its parent.
  struct Edge {
    std::string parent, child;
    Eigen::Isometry3d parent_T_child;
  };
  /// The named frames, the cameras and the base in the world.
  const std::vector<Edge>& fixed() const { return fixed_; }

  /// The frames of all joints at the independent joint values `q`.
  void write_moving(const JointVector& q, Time stamp, msg::TFMessage& message) const;
  /// All others: they never move against their parent.
  void write_fixed(Time stamp, msg::TFMessage& message) const;

 private:
  FrameTree(const RobotModel& model, const Parameters& parameters)
      : model_{&model}, parameters_{parameters} {}
  void add_fixed(const std::optional<StereoRig>& rig);
  Expected<void> check_names() const;

  const RobotModel* model_;
  Parameters parameters_;
  std::vector<Edge> fixed_;
};

}  // namespace armature::monitor::rviz
