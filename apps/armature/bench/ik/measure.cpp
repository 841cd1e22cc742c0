// SPDX-License-Identifier: Apache-2.0
#include "bench/ik/measure.hpp"

#include <algorithm>
#include <limits>

#include "armature/robot/kinematics/kinematics.hpp"
#include "armature/runtime/plugins/running_component.hpp"
#include "bench/clock.hpp"
#include "bench/turns.hpp"

namespace armature::bench {
namespace {

/// Does the branch reach the goal with joints within limits? By forward kinematics and the robot's
/// limits, whatever the branch says of itself.
void judge(const RobotModel& model, const Pose& pose, const IkBranch& branch, Solve& solve) {
  JointVector q = branch.q;
  const bool sound = q.size() == model.dof() && q.allFinite();
  const bool within = sound && unwind(model, pose.q, q) && model.within_limits(q);
  const Eigen::Vector3d axis = model.pointing_axis().value_or(Eigen::Vector3d::UnitX());
  PoseResidual off{std::numeric_limits<double>::infinity(), 0};
  if (sound) off = residual(forward_kinematics(model, q), axis, pose.goal.pose);
  const auto& [position_m, angle_rad] = pose.goal.tolerance;
  const bool hits = off.position_m <= position_m && off.angle_rad <= angle_rad;
  if (branch.within_limits && !(within && hits)) solve.wrong = true;
  if (!within) return;
  solve.reached = solve.reached || hits;
  if (off.position_m < solve.position_m) {
    solve.position_m = off.position_m;
    solve.angle_rad = off.angle_rad;
  }
}

Solve checked(const RobotModel& model, const Runner& runner, const Pose& pose, Seeds seeds,
              AllocationCounter allocations) {
  IkBranches found;
  IkState state;
  Solve solve;
  solve.seconds = solve.position_m = solve.angle_rad = std::numeric_limits<double>::infinity();
  const RunningComponent running{runner.plugin, "solve", "plugin"};
  const std::size_t before = allocations ? allocations() : 0;
  runner.solver->solve(pose.goal, pose.seed(seeds), found, state);
  if (allocations) solve.allocations = allocations() - before;
  solve.branches = found.count;
  for (const IkBranch& branch : found) judge(model, pose, branch, solve);
  return solve;
}

/// Poses [from, to) with one runner, with the clock.
void time_block(const Runner& runner, const std::vector<Pose>& poses, std::size_t from,
                std::size_t to, double clock_s, Series& series) {
  const RunningComponent running{runner.plugin, "solve", "plugin"};
  IkBranches found;
  for (std::size_t i = from; i < to; ++i) {
    const JointVector& seed = poses[i].seed(series.seeds);
    IkState state;
    const auto start = Clock::now();
    runner.solver->solve(poses[i].goal, seed, found, state);
    const auto end = Clock::now();
    const double seconds = std::max(0.0, seconds_between(start, end) - clock_s);
    series.solves[i].seconds = std::min(series.solves[i].seconds, seconds);
  }
}

}  // namespace

std::vector<double> Series::seconds() const {
  std::vector<double> list;
  for (const Solve& solve : solves) list.push_back(solve.seconds);
  return list;
}

std::vector<Series> measure(const RobotModel& model, const std::vector<Runner>& runners,
                            const std::vector<Pose>& poses, const MeasureOptions& options) {
  std::vector<Series> all;
  std::vector<const Runner*> runner_of;
  for (const Runner& runner : runners) {
    for (const Seeds seeds : options.seeds) {
      all.push_back({runner.plugin, seeds, {}});
      runner_of.push_back(&runner);
      for (const Pose& pose : poses) {
        all.back().solves.push_back(checked(model, runner, pose, seeds, options.allocations));
      }
    }
  }
  const double clock_s = clock_seconds();
  take_turns({.contestants = all.size(),
              .items = poses.size(),
              .repetitions = options.repetitions,
              .order = options.order,
              .progress = options.progress},
             [&](std::size_t k, std::size_t from, std::size_t to) {
               time_block(*runner_of[k], poses, from, to, clock_s, all[k]);
             });
  return all;
}

}  // namespace armature::bench
