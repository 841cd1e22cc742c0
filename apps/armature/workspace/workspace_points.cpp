// SPDX-License-Identifier: Apache-2.0
#include "workspace/workspace_points.hpp"

#include <cmath>
#include <numbers>
#include <optional>
#include <random>

#include "armature/robot/kinematics/kinematics.hpp"
#include "bench/random_joints.hpp"

namespace armature {
namespace {

using Eigen::Isometry3d;
using Eigen::Vector3d;

constexpr int kRolls = 12;        // about the shaft, that are tried
constexpr double kExact = 1e-6;   // [m] and [rad]: a workspace need not be known better
constexpr int kIterations = 100;  // of iterative solvers

std::optional<JointVector> within_limits(const IkSolver& solver, const IkGoal& goal,
                                         const JointVector& seed) {
  IkBranches branches;
  IkState state{.last_redundancy = solver.redundancy_of(seed)};
  solver.solve(goal, seed, branches, state);
  for (const IkBranch& branch : branches) {
    if (branch.within_limits) return branch.q;
  }
  return std::nullopt;
}

/// Joints within limits for one pose, whatever the redundancy of the arm.
std::optional<JointVector> joints_at(const IkSolver& solver, const Isometry3d& pose,
                                     const JointVector& seed) {
  IkGoal goal{.pose = {pose.translation(), Eigen::Quaterniond{pose.linear()}},
              .tolerance = {kExact, kExact},
              .max_iterations = kIterations};
  if (auto q = within_limits(solver, goal, seed)) return q;
  RedundancyIntervals intervals;
  if (!solver.feasible_redundancy(goal, seed, intervals)) return std::nullopt;
  for (const RedundancyInterval& interval : intervals) {
    goal.redundancy = 0.5 * (interval.lower + interval.upper);
    if (auto q = within_limits(solver, goal, seed)) return q;
  }
  return std::nullopt;
}

/// Evenly in a ball without its core.
Vector3d any_place(const RemoteCentre& centre, double min_depth, std::mt19937_64& random) {
  std::uniform_real_distribution<double> part{0, 1};
  const double core = std::pow(min_depth / centre.shaft.length, 3);
  const double depth = centre.shaft.length * std::cbrt(core + (1 - core) * part(random));
  const double z = 2 * part(random) - 1, angle = 2 * std::numbers::pi * part(random);
  const double radius = std::sqrt(1 - z * z);
  return centre.point + depth * Vector3d{radius * std::cos(angle), radius * std::sin(angle), z};
}

}  // namespace

Workspace free_workspace(const RobotModel& model, std::size_t samples, std::uint64_t seed) {
  std::mt19937_64 random{seed};
  std::uniform_real_distribution<double> part{0, 1};
  Workspace found{.points = {}, .tried = samples};
  for (std::size_t i = 0; i < samples; ++i) {
    JointVector q{model.dof()};
    for (int j = 0; j < model.dof(); ++j) {
      const auto [lower, upper] = bench::range(model, j);
      q[j] = lower + part(random) * (upper - lower);
    }
    found.points.push_back({forward_kinematics(model, q).translation(), q});
  }
  return found;
}

Workspace workspace_about(const RemoteCentre& centre, double min_depth, const RobotModel& model,
                          const IkSolver& solver, std::size_t samples, std::uint64_t seed) {
  std::mt19937_64 random{seed};
  const JointVector home = resting_position(model);
  const Eigen::Matrix3d rotation = forward_kinematics(model, home).linear();
  Workspace found{.points = {}, .tried = samples};
  for (std::size_t i = 0; i < samples; ++i) {
    const Vector3d place = any_place(centre, min_depth, random);
    for (int roll = 0; roll < kRolls; ++roll) {
      const Eigen::AngleAxisd turn{2 * std::numbers::pi * roll / kRolls, centre.shaft.axis};
      const Isometry3d pose =
          centre.pivoted(Eigen::Translation3d{place} * Eigen::Quaterniond{rotation * turn});
      const auto q = joints_at(solver, pose, home);
      if (!q) continue;
      found.points.push_back({place, *q});
      break;
    }
  }
  return found;
}

double ball_volume(const RemoteCentre& centre, double min_depth) {
  return 4.0 / 3 * std::numbers::pi * (std::pow(centre.shaft.length, 3) - std::pow(min_depth, 3));
}

}  // namespace armature
