// SPDX-License-Identifier: Apache-2.0
#include "armature/motion/goal_planner.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <numbers>
#include <utility>

#include "armature/kinds/trajectory/legs.hpp"
#include "armature/motion/left_path.hpp"
#include "armature/motion/missed_pose.hpp"
#include "armature/robot/kinematics/kinematics.hpp"
#include "armature/robot/kinematics/link_clearance.hpp"
#include "armature/robot/trajectories/retiming.hpp"
#include "armature/values/guarded.hpp"

namespace armature {
namespace {

tl::unexpected<PlanFailure> fail(std::string stage, std::string reason) {
  return tl::unexpected<PlanFailure>{PlanFailure{std::move(stage), std::move(reason)}};
}

/// A cartesian segment starts where the one before ended; that point needs no solution of its own.
bool is_known(const PathSegment& segment, std::size_t sample) {
  return segment.space == PathSegment::Space::cartesian && sample == 0 &&
         segment.samples.front().s <= 0;
}

std::string name_of(const Path& path, std::size_t segment, std::size_t sample) {
  return fmt::format("sample {} of {} of segment {}", sample + 1, path[segment].samples.size(),
                     segment + 1);
}

Path straight_to(const ToolPose& pose) {
  return {PathSegment{.space = PathSegment::Space::joint,
                      .samples = {PathSample{.s = 1, .pose = pose}},
                      .stop_at_end = true,
                      .duration_s = std::nullopt}};
}

/// The goal of a sample; its redundancy counts for an arm which has a freedom more than the pose
/// takes.
Expected<IkGoal> ik_goal(const RobotModel& model, const IkSolver& solver,
                         const PathSample& sample) {
  const int taken = std::holds_alternative<Direction>(sample.pose.orientation) ? 5 : 6;
  IkGoal goal;
  goal.pose = sample.pose;
  if (model.dof() <= taken || !sample.redundancy) return goal;
  if (solver.redundancy_is_length() != sample.redundancy->is_length) {
    return refuse(
        sample.redundancy->is_length
            ? "the path states a length, such as a needle's depth, and the solver holds none"
            : "the path states an arm angle, and the solver holds a length");
  }
  goal.redundancy = sample.redundancy->value;
  return goal;
}

/// The one branch of a sample that names its joints, or what is wrong with them.
std::string take_joints(const RobotModel& model, const PathSegment& segment,
                        const PathSample& sample, const JointVector& before, IkBranches& branches) {
  if (segment.space != PathSegment::Space::joint) return "a cartesian segment names joints";
  if (sample.joints->size() != model.dof()) {
    return fmt::format("{} joints, and the robot has {}", sample.joints->size(), model.dof());
  }
  if (!sample.joints->allFinite()) return "its joints are not finite";
  if (!model.within_limits(*sample.joints)) return "its joints are beyond their limits";
  for (int i = 0; i < model.dof(); ++i) {
    // Whoever chooses turns joints to the nearest of their whole turns.
    const double turn = std::abs((*sample.joints)[i] - before[i]);
    if (model.is_revolute(i) && !(turn < std::numbers::pi)) {
      return fmt::format("a joint turns by {:.3f} rad at once: name a sample between", turn);
    }
  }
  const ReasonText missed = missed_by(model, *sample.joints, sample.pose);
  if (!missed.empty()) {
    return fmt::format("its joints take the tool past its pose by {}", missed.view());
  }
  branches.clear();
  branches.add() = branch_at(model, {.pose = sample.pose}, *sample.joints, "of the path");
  return {};
}

/// Which branch was reached, or why none. A solver answers every branch and is not told which one
/// is taken: what it is to remember of the last choice follows from the joints `seed`, which were
/// it.
Expected<IkStatus> solved(const IkSolver& solver, const IkGoal& goal, const JointVector& seed,
                          IkBranches& branches, IkState& state) {
  return guarded(state, [&](IkState& s) {
    s.last_redundancy = solver.redundancy_of(seed);
    return solver.solve(goal, seed, branches, s);
  });
}

/// [m/s] The greatest speed of the tool's position, by samples 2 ms apart or closer.
double peak_speed(const Trajectory& trajectory, const RobotModel& model) {
  const double step_s = std::clamp(trajectory.duration_s() / 1000, 1e-5, 2e-3);
  const TrajectoryView view = trajectory.view();
  double peak = 0;
  for (double t = 0; t < trajectory.duration_s(); t += step_s) {
    const JointState state = state_at(view, t);
    const Eigen::VectorXd twist =
        forward_kinematics_with_jacobian(model, state.q, model.tool()).jacobian * state.v;
    peak = std::max(peak, twist.head<3>().norm());
  }
  return peak;
}

bool leaves_limits(const Trajectory& trajectory, const RobotModel& model) {
  const auto dof = static_cast<std::size_t>(trajectory.dof);
  for (std::size_t i = 0; i < trajectory.pieces.size(); ++i) {
    const std::size_t k = i / dof;
    const auto joint = static_cast<Eigen::Index>(i % dof);
    const QuinticRange q =
        range(trajectory.pieces[i], trajectory.knots[k + 1] - trajectory.knots[k]);
    if (q.lowest < model.lower()[joint] || q.highest > model.upper()[joint]) return true;
  }
  return false;
}

/// `defect`, and the way out where the curve between samples that are within the limits swings out
/// of them: a solver that goes along a limit turns there as sharply as it comes.
std::string with_way_out(std::string defect, const Plan& plan, const RobotModel& model) {
  for (const JointSegment& segment : plan.joint_path) {
    for (const JointVector& q : segment.q) {
      if (!model.within_limits(q)) return defect;
    }
  }
  if (!leaves_limits(plan.trajectory, model)) return defect;
  return defect +
         "; no sample of its path does: give the curve between them room with limit_margin_deg (or "
         "_mm)";
}

/// [s] Where the joint segments end that the way begins with: at a stop. Behind the way where there
/// is none.
double begin_of_lines_s(const Plan& plan) {
  double begin_s = 0;
  for (std::size_t k = 0; k < plan.path.size(); ++k) {
    if (plan.path[k].space == PathSegment::Space::cartesian) return begin_s;
    if (!plan.path[k].stop_at_end) break;
    if (moves(plan.joint_path[k])) begin_s = next_rest_s(plan.trajectory, begin_s);
  }
  return kToolEntersNothing;
}

/// A splice would leave the key poses, and an arm that is faster than it may be is not spliced.
bool begins_at_rest(const MotionGoal& goal) { return !goal.through.empty() || goal.max_speed > 0; }

}  // namespace

GoalPlanner::GoalPlanner(const RobotModel& model, const PlanStages& stages,
                         const MotionLimits& limits, const PlanningOptions& options)
    : model_{model}, stages_{stages}, limits_{limits}, options_{options} {}

/// Why a solver did not reach a pose.
std::string GoalPlanner::reason_of(const Expected<IkStatus>& status) const {
  if (!status) return status.error().text;
  const bool by_limits =
      status->code == IkStatus::Code::joint_limit || status->code == IkStatus::Code::no_convergence;
  if (!options_.narrow_solver || !by_limits) return describe(*status);
  return describe(*status) + "; limit_margin_deg or _mm narrows its limits";
}

tl::expected<JointVector, PlanFailure> GoalPlanner::solve(const ToolPose& pose,
                                                          const JointVector& near) {
  waypoints_.resize(1);
  IkState state;
  const auto status = solved(*stages_.ik, IkGoal{.pose = pose}, near, waypoints_[0], state);
  if (!status || !reaches(*status)) return fail("ik", "the goal: " + reason_of(status));
  auto chosen = chosen_by(*stages_.select, model_, near, waypoints_);
  if (!chosen) return fail("select", chosen.error().text);
  return chosen->front();
}

bool GoalPlanner::is_bound_to_path(const MotionGoal& goal) const {
  return options_.path_only || goal.stepwise || !goal.through.empty() || !goal.forbidden.empty();
}

PlanResult GoalPlanner::plan(const MotionGoal& goal, const JointState& from, Time start) {
  if (auto end = solve(goal.pose, from.q); !end) return tl::unexpected{end.error()};
  const bool moving = !at_rest(from), stops_first = moving && begins_at_rest(goal);
  PlanResult first =
      stops_first ? after_stop(goal, from, start, false) : attempt(goal, from, start, false);
  if (first) return first;
  if (moving && !stops_first) {
    if (PlanResult stopped = after_stop(goal, from, start, false)) return stopped;
  }
  if (is_bound_to_path(goal)) return first;
  PlanResult straight =
      moving ? after_stop(goal, from, start, true) : attempt(goal, from, start, true);
  if (!straight) return first;
  straight->straight_because = first.error().stage + ": " + first.error().reason;
  return straight;
}

PlanResult GoalPlanner::after_stop(const MotionGoal& goal, const JointState& from, Time start,
                                   bool straight) {
  const Trajectory stop =
      stop_from(from, limits_.max_velocity, limits_.max_acceleration, start, goal.id);
  JointState rest = stop.at(stop.end());
  rest.v.setZero();
  rest.a.setZero();
  PlanResult plan = attempt(goal, rest, stop.end(), straight);
  if (!plan) return plan;
  plan->trajectory = followed_by(stop, plan->trajectory);
  const ReasonText wrong = trajectory_defect(plan->trajectory.view(), model_, limits_, from, start);
  if (!wrong.empty()) return fail("trajectory", std::string{wrong.view()});
  return plan;
}

PlanResult GoalPlanner::attempt(const MotionGoal& goal, const JointState& from, Time start,
                                bool straight) {
  Plan plan;
  if (straight) {
    plan.path = straight_to(goal.pose);
  } else {
    auto path = guarded([&] {
      return stages_.path->plan({.start = pose_at(model_, from.q, goal.pose),
                                 .goal = goal.pose,
                                 .focus = goal.focus,
                                 .through = goal.through,
                                 .forbidden = goal.forbidden,
                                 .start_joints = from.q});
    });
    if (!path) return fail("path", path.error().text);
    plan.path = std::move(*path);
  }
  if (auto solved = solve_samples(plan.path, from.q); !solved) {
    return tl::unexpected{solved.error()};
  }
  std::optional<PlanFailure> first;
  for (;;) {
    auto joint_path = this->joint_path(plan.path, from.q);
    if (!joint_path) return tl::unexpected{first.value_or(joint_path.error())};
    plan.joint_path = std::move(*joint_path);
    const auto failure = time(plan, goal, from, start);
    if (!failure) return plan;
    if (!first) first = failure;
    if (!without_branch_of(plan)) return tl::unexpected{*first};
  }
}

std::optional<PlanFailure> GoalPlanner::time(Plan& plan, const MotionGoal& goal,
                                             const JointState& from, Time start) const {
  const ReasonText missed = missed_by(model_, plan.joint_path.back().q.back(), goal.pose);
  if (!missed.empty()) {
    return PlanFailure{"path", fmt::format("the path's end misses the goal by {}", missed.view())};
  }
  auto trajectory = guarded([&] {
    return stages_.trajectory->plan({.goal_id = goal.id,
                                     .start = start,
                                     .from = from,
                                     .segments = plan.joint_path,
                                     .max_velocity = limits_.max_velocity,
                                     .max_acceleration = limits_.max_acceleration,
                                     .max_jerk = limits_.max_jerk});
  });
  if (!trajectory) return PlanFailure{"trajectory", trajectory.error().text};
  plan.trajectory = std::move(*trajectory);
  plan.trajectory.goal_id = goal.id;
  const TrajectoryView made = plan.trajectory.view();
  ReasonText wrong = trajectory_defect(made, model_, limits_, from, start);
  if (wrong.empty()) wrong = missed_goal(made, model_, plan.joint_path.back().q.back());
  if (!wrong.empty()) {
    return PlanFailure{"trajectory", with_way_out(std::string{wrong.view()}, plan, model_)};
  }
  if (is_bound_to_path(goal)) {
    if (auto left = left_path(model_, plan, options_.max_path_deviation)) {
      return PlanFailure{"trajectory", std::move(*left)};
    }
  }
  if (goal.max_speed > 0) {
    constexpr double kBetweenSamples = 1.0001;
    const double slower = kBetweenSamples * peak_speed(plan.trajectory, model_) / goal.max_speed;
    if (slower > 1) plan.trajectory = stretched(plan.trajectory, slower);
  }
  return obstacle(plan, goal);
}

std::optional<PlanFailure> GoalPlanner::obstacle(const Plan& plan, const MotionGoal& goal) const {
  const auto found = first_violation(model_, plan.trajectory.view(), goal.forbidden,
                                     options_.min_link_clearance, begin_of_lines_s(plan));
  if (!found) return std::nullopt;
  return PlanFailure{
      "links",
      fmt::format(
          "link '{}' comes nearer than {:g} mm (min_link_clearance_mm) to '{}', {:.2f} s after the "
          "start of the way, and no other branch of the arm leads from here to the goal: lead it "
          "to another start",
          model_.capsules()[found->where.capsule].name, 1e3 * options_.min_link_clearance,
          goal.forbidden[found->where.zone].name, found->t_s)};
}

bool GoalPlanner::without_branch_of(const Plan& plan) {
  // Off a line the arm may not swing to another branch.
  if (plan.path.front().space != PathSegment::Space::joint) return false;
  const IkBranch* taken = nearest_branch(waypoints_.front(), plan.joint_path.front().q[1], model_);
  if (!taken) return false;
  const std::string label{taken->label};
  for (IkBranches& branches : waypoints_) {
    IkBranches others;
    for (const IkBranch& branch : branches) {
      if (branch.label != label) others.add() = branch;
    }
    if (others.count == 0) return false;
    branches = others;
  }
  return true;
}

tl::expected<void, PlanFailure> GoalPlanner::solve_samples(const Path& path,
                                                           const JointVector& start) {
  waypoints_.clear();
  JointVector seed = start;
  IkState state;
  for (std::size_t k = 0; k < path.size(); ++k) {
    const auto& samples = path[k].samples;
    for (std::size_t i = 0; i < samples.size(); ++i) {
      if (is_known(path[k], i)) continue;
      IkBranches& branches = waypoints_.emplace_back();
      if (samples[i].joints) {
        const std::string wrong = take_joints(model_, path[k], samples[i], seed, branches);
        if (!wrong.empty()) return fail("path", name_of(path, k, i) + ": " + wrong);
        seed = *samples[i].joints;
        continue;
      }
      const auto goal = ik_goal(model_, *stages_.ik, samples[i]);
      if (!goal) return fail("ik", goal.error().text);
      const auto status = solved(*stages_.ik, *goal, seed, branches, state);
      const IkBranch* next =
          status && reaches(*status) ? nearest_branch(branches, seed, model_) : nullptr;
      if (!next) {
        return fail("ik", name_of(path, k, i) + ": " + reason_of(status));
      }
      seed = next->q;
    }
  }
  return {};
}

tl::expected<std::vector<JointSegment>, PlanFailure> GoalPlanner::joint_path(
    const Path& path, const JointVector& start) {
  if (waypoints_.empty()) return fail("path", "the path has no samples");
  auto chosen = chosen_by(*stages_.select, model_, start, waypoints_);
  if (!chosen) return fail("select", chosen.error().text);
  std::vector<JointSegment> segments;
  JointVector last = start;
  std::size_t next = 0;
  for (std::size_t k = 0; k < path.size(); ++k) {
    const PathSegment& segment = path[k];
    if (segment.samples.empty()) return fail("path", fmt::format("segment {} is empty", k + 1));
    JointSegment& joint = segments.emplace_back(JointSegment{.s = {0.0},
                                                             .q = {last},
                                                             .stop_at_end = segment.stop_at_end,
                                                             .duration_s = segment.duration_s});
    for (std::size_t i = 0; i < segment.samples.size(); ++i) {
      if (is_known(segment, i)) continue;
      if (!(segment.samples[i].s > joint.s.back())) {
        return fail("path", "the samples of a segment do not ascend in s");
      }
      joint.s.push_back(segment.samples[i].s);
      joint.q.push_back((*chosen)[next++]);
      const ReasonText missed = missed_by(model_, joint.q.back(), segment.samples[i].pose);
      if (!missed.empty()) {
        return fail("ik", fmt::format("{}: the branch that was taken misses its pose by {}",
                                      name_of(path, k, i), missed.view()));
      }
    }
    last = joint.q.back();
  }
  return segments;
}

}  // namespace armature
