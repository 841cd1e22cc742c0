// SPDX-License-Identifier: Apache-2.0
#include "armature/motion/planner_component.hpp"

#include <fmt/core.h>

#include <algorithm>

#include "armature/kinds/setup_robot.hpp"
#include "armature/kinds/trajectory/trajectory_messages.hpp"
#include "armature/motion/joint_bound.hpp"
#include "armature/motion/motion_messages.hpp"
#include "armature/motion/motion_params.hpp"

namespace armature {
namespace {

/// Of the way that an arm joins again: a millimetre at the tool of an arm of half a metre.
constexpr JointBound kJoinWithin{.turning_rad = 0.002, .sliding_m = 0.0005};
constexpr std::size_t kKnownGoals = 16;  // one that waits for its plan is among the last eight

}  // namespace

MotionPlanner::MotionPlanner(Setup& setup)
    : Component(setup),
      model_{robot_of(setup)},
      solver_model_{solver_model_of(setup.params(), model_)},
      ports_{setup},
      planner_{model_,
               {.path = setup.slot<PathPlanner>("path", model_),
                .ik = setup.slot<IkSolver>("ik", solver_model_),
                .select = setup.slot<BranchSelector>("select", model_),
                .trajectory = setup.slot<TrajectoryPlanner>("trajectory")},
               limits_of(setup.params(), model_),
               planning_of(motion::Parameters::read(setup.params()))},
      ways_{planner_.limits(), each(kJoinWithin, model_)} {
  setup.deliver_after(seconds(motion::Parameters::read(setup.params()).plan_budget / 2));
}

void MotionPlanner::step(Time) {
  for (std::size_t i = 0; i < ports_.goal.size(); ++i) known_.push_back(ports_.goal[i]);
  while (known_.size() > kKnownGoals) known_.pop_front();
  if (ports_.plan_request.fresh()) wanted_ = read_request(*ports_.plan_request.latest());
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

bool MotionPlanner::came_twice(const msg::MotionGoal& goal) const {
  return std::ranges::any_of(known_, [&](const msg::MotionGoal& other) {
    if (&other == &goal || other.goal_id_() != goal.goal_id_()) return false;
    msg::MotionGoal told_again = goal;
    told_again.header_() = other.header_();
    return told_again != other;
  });
}

void MotionPlanner::answer(const PlanRequest& request, const msg::MotionGoal& message) {
  const auto goal =
      came_twice(message)
          ? refuse("another goal has come with this id: every goal has an id of its own")
          : read_goal(message);
  planned_.reset();
  const WayLegResult leg =
      !goal ? WayLegResult{tl::unexpected{PlanFailure{"accept", goal.error().text}}}
      : goal->mode == MotionMode::planned ? plan(request, *goal)
                                          : change_way(request, *goal);
  auto answer = ports_.plan.loan();
  write_answer(request, leg, *answer);
  answer.publish();
  if (planned_) publish_path(*planned_);
  if (leg) publish_trajectory(leg->trajectory);
}

WayLegResult MotionPlanner::plan(const PlanRequest& request, const MotionGoal& goal) {
  PlanResult plan = planner_.plan(goal, request.from, request.start);
  if (!plan) return tl::unexpected{plan.error()};
  planned_ = std::move(*plan);
  tell_straight(*planned_, goal.id);
  return ways_.begin(*planned_, goal.stepwise);
}

/// Once for each reason.
void MotionPlanner::tell_straight(const Plan& plan, std::uint64_t goal_id) {
  const std::string& why = plan.straight_because;
  if (why.empty() || told_.find(why)) return;
  told_.put(why, {});
  log(fmt::format("goal {}: {}; straight in joint space instead", goal_id, why));
}

WayLegResult MotionPlanner::change_way(const PlanRequest& request, const MotionGoal& goal) {
  WayLegResult leg = ways_.change(goal.mode, goal.stepwise, request);
  if (!leg) return leg;
  const ReasonText wrong = trajectory_defect(leg->trajectory.view(), model_, planner_.limits(),
                                             request.from, request.start);
  if (wrong.empty()) return leg;
  return tl::unexpected{PlanFailure{"trajectory", std::string{wrong.view()}}};
}

void MotionPlanner::publish_path(const Plan& plan) {
  auto path = ports_.path.loan();
  write_path(plan, model_, *path);
  path.publish();
  auto joint_path = ports_.joint_path.loan();
  write_joint_path(plan, model_, *joint_path);
  joint_path.publish();
}

void MotionPlanner::publish_trajectory(const Trajectory& trajectory) {
  auto pieces = ports_.trajectory.loan();
  write_trajectory(trajectory, model_, *pieces);
  pieces.publish();
  auto points = ports_.joint_trajectory.loan();
  write_trajectory_points(trajectory, model_, *points);
  points.publish();
}

}  // namespace armature
