// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>

#include "armature/messages/armature_msgs.hpp"
#include "armature/messages/std_msgs.hpp"
#include "armature/messages/visualization_msgs.hpp"
#include "frame_tree.hpp"
#include "markers.hpp"
#include "monitor_rviz_parameters.hpp"

namespace armature::monitor::rviz {

/// Which goal the arm is after, so that a path is shown no longer than it is followed.
class GoalWatch {
 public:
  void see(const msg::MotionStatus& status);
  /// True while the goal is accepted or executed, and before anything was told of it.
  bool pursues(std::uint64_t goal_id) const;

 private:
  std::optional<std::uint64_t> newest_;
  bool active_ = false;
};

/// What the picture shows besides the robot; nullptr: nothing is known of it.
struct Surroundings {
  const msg::Target* target = nullptr;
  const msg::Target* truth = nullptr;
  const msg::FacePose* face = nullptr;
  const msg::ToolPath* path = nullptr;
  bool path_is_followed = false;
};

/// Draws the system as markers: namespaces `links`, `pointing`, `target`, `truth`, `face`, `path`,
/// ids that stay, all of it in every array. What is not there any more is taken away.
class Picture {
 public:
  /// `model` and `tree` must outlive it.
  Picture(const RobotModel& model, const FrameTree& tree, const Parameters& parameters);

  /// The robot at the independent joint values `q` of the joint sample `stamp`.
  msg::MarkerArray draw(const JointVector& q, Time stamp, const Surroundings& around) const;

 private:
  void add_links(const JointVector& q, Time stamp, msg::MarkerArray& array) const;
  void add_pointing(Time stamp, msg::MarkerArray& array) const;
  void add_target(const char* ns, const msg::Target* target, Time stamp, Color color,
                  msg::MarkerArray& array) const;
  void add_face(const msg::FacePose* face, Time now, msg::MarkerArray& array) const;
  void add_path(const Surroundings& around, Time stamp, msg::MarkerArray& array) const;
  std::string frame_of(const msg::Header& header) const;

  const RobotModel* model_;
  const FrameTree* tree_;
  Parameters parameters_;
  double radius_;  // [m] of a link
};

}  // namespace armature::monitor::rviz
