// SPDX-License-Identifier: Apache-2.0
#include "armature/motion/planner_component.hpp"

#include <fmt/core.h>

#include <algorithm>

#include "armature/kinds/setup_robot.hpp"
#include "armature/kinds/trajectory/trajectory_messages.hpp"
#include "armature/motion/motion_messages.hpp"
#include "armature/motion/motion_params.hpp"

namespace armature {
namespace {

constexpr std::size_t kKnownGoals = 16;  // one that waits for its plan is among the last eight

}  // namespace

MotionPlanner::MotionPlanner(Setup& setup)
    : Component(setup),
      model_{robot_of(setup)},
      solver_model_{solver_model_of(setup.params(), model_)},
      goals_{setup.input<msg::MotionGoal>("goal")},
      requests_{setup.input<msg::MotionPlanRequest>("plan_request")},
      plan_{setup.output<msg::MotionPlan>("plan")},
      path_out_{setup.output<msg::ToolPath>("path")},
      joint_path_out_{setup.output<msg::JointTrajectory>("joint_path")},
      joint_trajectory_out_{setup.output<msg::JointTrajectory>("joint_trajectory")},
      trajectory_out_{setup.output<msg::QuinticTrajectory>("trajectory")},
      planner_{model_,
               {.path = setup.slot<PathPlanner>("path", model_),
                .ik = setup.slot<IkSolver>("ik", solver_model_),
                .select = setup.slot<BranchSelector>("select", model_),
                .trajectory = setup.slot<TrajectoryPlanner>("trajectory")},
               limits_of(setup.params(), model_),
               planning_of(motion::Parameters::read(setup.params()))} {
  setup.deliver_after(seconds(motion::Parameters::read(setup.params()).plan_budget / 2));
}

void MotionPlanner::step(Time) {
  for (std::size_t i = 0; i < goals_.size(); ++i) known_.push_back(goals_[i]);
  while (known_.size() > kKnownGoals) known_.pop_front();
  if (requests_.fresh()) wanted_ = read_request(*requests_.latest());
  if (!wanted_) return;
  // Both units hear of a goal by themselves: its request may be here first.
  const msg::MotionGoal* goal = find(wanted_->goal_id);
  if (!goal) return;
  answer(*wanted_, *goal);
  wanted_.reset();
}

const msg::MotionGoal* MotionPlanner::find(std::uint64_t goal_id) const {
  const auto found = std::find_if(known_.rbegin(), known_.rend(), [&](const msg::MotionGoal& goal) {
    return goal.goal_id_() == goal_id;
  });
  return found == known_.rend() ? nullptr : &*found;
}

void MotionPlanner::answer(const PlanRequest& request, const msg::MotionGoal& message) {
  const auto goal = read_goal(message);
  const PlanResult result =
      goal ? planner_.plan(*goal, request.from, request.start)
           : PlanResult{tl::unexpected{PlanFailure{"accept", goal.error().text}}};
  auto plan = plan_.loan();
  write_answer(request, result, *plan);
  plan.publish();
  if (result) publish_stages(*result);
}

void MotionPlanner::publish_stages(const Plan& plan) {
  auto path = path_out_.loan();
  write_path(plan, model_, *path);
  path.publish();
  auto joint_path = joint_path_out_.loan();
  write_joint_path(plan, model_, *joint_path);
  joint_path.publish();
  auto trajectory = trajectory_out_.loan();
  write_trajectory(plan.trajectory, model_, *trajectory);
  trajectory.publish();
  auto points = joint_trajectory_out_.loan();
  write_trajectory_points(plan.trajectory, model_, *points);
  points.publish();
}

}  // namespace armature
