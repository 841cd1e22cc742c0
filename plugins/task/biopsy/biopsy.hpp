// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Geometry>
#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "armature/robot/geometry/forbidden_zone.hpp"
#include "armature/robot/model/robot_model.hpp"
#include "armature/task/procedure.hpp"
#include "armature/task/pursued_goal.hpp"
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

/// The scenario of one biopsy. Everything it knows comes in through the `see` and `hear` calls;
/// `update` decides. The needle goes along one planned way, which stops at the stand-off, at the
/// entry and at the target, and comes back along it.
class Biopsy {
 public:
  enum class Step : std::size_t { registration, approach, entry, insertion, withdrawal };
  enum class Phase {
    waiting,      // for plan and markers
    registering,  // until the registration has answered
    asking,       // the operator is to confirm a step
    moving,       // towards the target
    at_target,
    withdrawing,
    going_back,  // one stop, since the operator wants it
    aborting,    // to where the way began
    held,        // it broke down on its way: the operator leads it back
    withdrawn,
    aborted,
    refused,
  };

  Biopsy(const Parameters& parameters, const RobotModel& robot);

  /// The plan on the image and where points were found before the robot are there.
  void see_head(const NeedleLine& plan);
  void see_registration(const RegisteredHead& head);
  void see_refused_registration(const std::string& reason) { refuse(reason); }
  void hear(const GoalReport& report, Time now);
  Expected<void> hear(const OperatorCommand& command);
  void update(Time now);

  /// True from the plan until the registration has answered.
  bool wants_registration() const { return has_plan_ && !line_ && !procedure_.over(); }
  std::optional<MotionGoal> outgoing_goal(Time now) { return goal_.outgoing(now); }

  Phase phase() const;
  const Procedure& procedure() const { return procedure_; }
  /// Why it does not go on, or "".
  const std::string& trouble() const { return trouble_; }

 private:
  enum class Heading { none, onward, back, out, home };
  /// Where it goes, or will as soon as the arm rests.
  Heading heading() const { return turning_to_ != Heading::none ? turning_to_ : heading_; }

  Step step() const { return static_cast<Step>(procedure_.step()); }
  void enter(Step step) { procedure_.enter(static_cast<std::size_t>(step)); }
  void set_out();
  void arrive(Time now);
  /// The step that begins at a stop of the way: 0 is its start, `way_stops_` the target.
  Step step_from(int place) const;
  Expected<void> go_back();
  Expected<void> abort();
  /// Along the way, once the arm rests.
  void turn_to(Heading heading);
  /// For good; or, of a needle that has set out, until an operator who is there leads it back.
  void break_down(const std::string& why);
  void refuse(const std::string& why);

  Parameters parameters_;
  const RobotModel& robot_;
  Procedure procedure_;
  NeedleLine plan_;
  bool has_plan_ = false;
  std::optional<NeedleLine> line_;  // before the robot
  PursuedGoal goal_;
  Heading heading_ = Heading::none;     // of the goal that is pursued
  Heading turning_to_ = Heading::none;  // as soon as the arm rests
  int way_stops_ = 0;                   // 0: no way is planned
  int place_ = 0;                       // the stop where the arm rests, or rested last
  Time at_target_since_;
  Phase ended_as_ = Phase::withdrawn;
  bool held_ = false;
  std::string trouble_;
};

/// "waiting", "registering", "at target", ...
const char* to_string(Biopsy::Phase phase);

}  // namespace armature::task::biopsy
