// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Geometry>
#include <optional>
#include <string>
#include <vector>

#include "armature/motion/pursued_goal.hpp"
#include "armature/robot/geometry/forbidden_zone.hpp"
#include "armature/robot/model/robot_model.hpp"
#include "task_biopsy_parameters.hpp"

namespace armature::task::biopsy {

/// The plan, in one frame.
struct NeedleLine {
  Eigen::Vector3d entry, target;  // [m]
  std::vector<ForbiddenZone> forbidden;
};

/// What a registration answered.
struct RegisteredHead {
  Eigen::Affine3d robot_T_image = Eigen::Affine3d::Identity();
  double fiducial_error_m = 0;
  double target_error95_m = 0;
};

/// `line`, of the image, before the robot.
NeedleLine moved(const NeedleLine& line, const Eigen::Affine3d& robot_T_image);

/// The tool's pose with its tip at the target and the needle along the line: a direction for a
/// robot that names its pointing axis, else the rotation whose z is along it and whose x is as near
/// to that of the arm at home as that leaves it.
ToolPose pose_at_target(const NeedleLine& line, const RobotModel& robot);

/// The scenario of one biopsy. Everything it knows comes in through the `see` and `hear` calls.
class Biopsy {
 public:
  enum class Phase { waiting, registering, inserting, at_target, refused };

  Biopsy(const Parameters& parameters, const RobotModel& robot)
      : parameters_{parameters}, robot_{robot} {}

  /// The plan on the image and where points were found before the robot are there.
  void see_head(const NeedleLine& plan);
  void see_registration(const RegisteredHead& head);
  void see_refused_registration(const std::string& reason) { refuse(reason); }
  void hear(const GoalReport& report, Time now);

  /// True from the plan until the registration has answered.
  bool wants_registration() const { return phase_ == Phase::registering; }
  std::optional<MotionGoal> outgoing_goal(Time now) { return goal_.outgoing(now); }

  Phase phase() const { return phase_; }
  /// Why it does not go on, or "".
  const std::string& trouble() const { return trouble_; }

 private:
  void refuse(const std::string& why);

  Parameters parameters_;
  const RobotModel& robot_;
  NeedleLine plan_;
  PursuedGoal goal_;
  Phase phase_ = Phase::waiting;
  std::string trouble_;
};

/// "waiting", "registering", "inserting", "at target", "refused".
const char* to_string(Biopsy::Phase phase);

}  // namespace armature::task::biopsy
