// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <deque>
#include <optional>
#include <string>
#include <variant>

#include "armature/messages/armature_msgs.hpp"
#include "armature/motion/goal_planner.hpp"
#include "armature/motion/plan_exchange.hpp"
#include "armature/motion/way.hpp"
#include "armature/runtime/component/component.hpp"
#include "armature/runtime/component/setup.hpp"
#include "armature/values/recent.hpp"
#include "motion_ports.hpp"

namespace armature {

/// The unit `motion.planner`: keeps the goals, and when the unit that owns the reference asks for
/// one, calls the slots and answers with a plan or with the stage that refused. A solver may take
/// its time here: nothing that moves waits for it.
class MotionPlanner final : public Component {
 public:
  explicit MotionPlanner(Setup& setup);
  void step(Time now) override;

 private:
  const msg::MotionGoal* find(std::uint64_t goal_id) const;
  /// Two that differ have one id: which of them was accepted is not told.
  bool came_twice(const msg::MotionGoal& goal) const;
  void answer(const PlanRequest& request, const msg::MotionGoal& goal);
  WayLegResult plan(const PlanRequest& request, const MotionGoal& goal);
  void tell_straight(const Plan& plan, std::uint64_t goal_id);
  WayLegResult change_way(const PlanRequest& request, const MotionGoal& goal);
  void publish_path(const Plan& plan);
  void publish_trajectory(const Trajectory& trajectory);

  RobotModel model_, solver_model_;
  motion::PlannerPorts ports_;
  GoalPlanner planner_;
  Ways ways_;
  std::optional<Plan> planned_;               // whose path is still to be told
  std::deque<msg::MotionGoal> known_;         // newest last
  std::optional<PlanRequest> wanted_;         // whose goal has not come yet
  Recent<std::string, std::monostate> told_;  // why ways go straight
};

}  // namespace armature
