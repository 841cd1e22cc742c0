// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>

#include "armature/messages/armature_msgs.hpp"
#include "armature/messages/geometry.hpp"
#include "armature/messages/sensor_msgs.hpp"
#include "armature/motion/goal_execution.hpp"
#include "armature/motion/stop_inputs.hpp"
#include "armature/runtime/component/component.hpp"
#include "armature/runtime/component/setup.hpp"
#include "motion_parameters.hpp"

namespace armature {

/// The unit that owns the reference of an arm: evaluates it, tracks, watches the arm, stops. A step
/// takes microseconds whatever is asked of the arm: goals are planned by another unit, and nothing
/// here allocates or waits.
class Motion final : public Component {
 public:
  explicit Motion(Setup& setup);
  void step(Time now) override;
  void begin_stop(Time now) override;
  bool stopped() const override { return stopped_; }

 private:
  std::optional<MeasuredJoints> read_measured();
  /// False while there is a cause to stop.
  bool heed_stops(Time now);
  void read_incision();
  /// Why a shaft that is in an incision, or shall be, does not move for `goal`, or empty.
  ReasonText pivot_refusal(const MotionGoal& goal, Time now) const;
  /// Whether the tip waits before a target that cannot be met, and why.
  void see_waiting(Time now);
  void read_goals(Time now);
  void publish_request();
  void publish_statuses(Time now);
  void publish_status(const GoalStatus& status, Time now);
  void publish_reference(Time now);
  void show_health(Time now);

  motion::Parameters parameters_;
  RobotModel model_, solver_model_;
  std::string no_tracker_;  // why targets cannot be tracked
  Slot<IkSolver> ik_;       // for tracking only
  Input<msg::MotionGoal> goals_;
  Input<msg::MotionPlan> plans_;
  Input<msg::JointState> measured_js_;
  Input<msg::PointStamped> incision_;
  StopInputs stops_;
  Output<msg::MotionPlanRequest> plan_request_;
  Output<msg::JointState> servo_jp_;
  Output<msg::PoseStamped> setpoint_cp_;
  Output<msg::JointReference> reference_;
  Output<msg::MotionStatus> status_;
  std::optional<Tracker> tracker_;
  GoalExecution execution_;
  MotionGoal goal_;  // kept for its memory
  Time last_status_;
  std::optional<Time> first_step_;
  ReasonText bad_measurement_, bad_incision_, shown_trouble_;
  std::optional<Time> waits_since_, tracked_at_;  // the tip, before a target
  ReasonText waits_for_;
  bool stopping_ = false, stopped_ = false;  // with the run, for good
};

}  // namespace armature
