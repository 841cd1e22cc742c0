// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>

#include "armature/kinds/ik/contract/postures.hpp"
#include "armature/kinds/ik/contract/search.hpp"
#include "armature/robot/kinematics/kinematics.hpp"

namespace armature::ik_contract {
namespace {

constexpr int kStarts = 24;
constexpr int kSweeps = 400;
constexpr int kSteps = 16;       // along a turn of a joint
constexpr double kAsFar = 1e-9;  // [m]

/// The best posture that turning one joint after the other leads to from `q`.
template <class Cost>
double descend(const RobotModel& model, bool free, JointVector& q, Cost cost) {
  double best = cost(q);
  for (int sweep = 0; sweep < kSweeps; ++sweep) {
    const double before = best;
    for (int k = 0; k < model.dof(); ++k) {
      const auto along = [&](double value) {
        JointVector moved = q;
        moved[k] = value;
        return cost(moved);
      };
      const auto [lower, upper] = range_of(model, k, free);
      const int turns = free ? turns_until_same(model, k) : 0;
      const int steps = kSteps * std::max(turns, 1);
      const double step = (upper - lower) / (steps - 1);
      double centre = q[k], least = best;
      for (int i = 0; i < steps; ++i) {
        if (const double f = along(lower + i * step); f < least)
          least = f, centre = lower + i * step;
      }
      // A joint that turns all the way round may pass its end.
      const bool round = turns > 0;
      const double from = round ? centre - step : std::max(centre - step, lower);
      const double to = round ? centre + step : std::min(centre + step, upper);
      const double value = golden_section(from, to, along);
      for (const double candidate : {centre, value, lower, upper}) {
        if (const double f = along(candidate); f < best) best = f, q[k] = candidate;
      }
    }
    if (!(before - best > 1e-16)) break;
  }
  return best;
}

/// `q` with every joint that does not change the cost turned anywhere.
template <class Cost>
JointVector varied(const RobotModel& model, bool free, JointVector q, Random& random, Cost cost) {
  const double wanted = cost(q);
  const JointVector other = random_posture(model, random, free);
  for (int k = 0; k < model.dof(); ++k) {
    JointVector moved = q;
    moved[k] = other[k];
    if (std::abs(cost(moved) - wanted) < 1e-13) q = moved;
  }
  return q;
}

Eigen::Vector3d reach_centre(const RobotModel& model) {
  // As high on the axis as the second joint begins.
  const BaseAxis axis = base_axis(model);
  const Joint& first = model.joints().front();
  const double d = first.type == Joint::Type::revolute ? first.d : 0;
  return axis.point + (d - axis.direction.dot(axis.point)) * axis.direction;
}

struct Start {
  JointVector q;
  double cost;
};
template <class Cost>
std::vector<Start> descents(const RobotModel& model, bool free, Random& random, Cost cost) {
  std::vector<Start> ends;
  for (int i = 0; i < kStarts; ++i) {
    JointVector q = random_posture(model, random, free);
    const double reached = descend(model, free, q, cost);
    ends.push_back({q, reached});
  }
  std::ranges::sort(ends, {}, &Start::cost);
  return ends;
}

}  // namespace

BaseAxis base_axis(const RobotModel& model) {
  if (model.joints().front().type != Joint::Type::revolute) return {};
  const JointVector q = JointVector::Zero(model.dof());
  const auto [pose, J] = forward_kinematics_with_jacobian(model, q, model.tool());
  const Eigen::Vector3d z = J.col(0).tail<3>();
  if (std::abs(z.norm() - 1) > 1e-9) return {};  // another joint turns with the first
  // The tool's velocity is z x (p - point): from it the point of the axis nearest to the tool.
  const Eigen::Vector3d v = J.col(0).head<3>();
  return {pose.translation() - v.cross(z), z};
}

ReachBall reach_ball(const RobotModel& model, int count, Random& random) {
  ReachBall ball{reach_centre(model), 0, {}};
  const auto cost = [&](const JointVector& q) {
    return -(forward_kinematics(model, q).translation() - ball.centre).norm();
  };
  const auto ends = descents(model, true, random, cost);
  ball.radius = -ends.front().cost;
  std::vector<JointVector> farthest;
  for (const auto& [q, reached] : ends) {
    if (reached < ends.front().cost + kAsFar) farthest.push_back(q);
  }
  for (int i = 0; i < count; ++i) {
    const auto& q = farthest[static_cast<std::size_t>(i) % farthest.size()];
    ball.at_rim.push_back(varied(model, true, q, random, cost));
  }
  return ball;
}

std::vector<JointVector> extreme_postures(const RobotModel& model, Extreme extreme, int count,
                                          Random& random) {
  const Eigen::Vector3d centre = reach_centre(model);
  const double sign = extreme == Extreme::farthest ? -1 : 1;
  const auto cost = [&](const JointVector& q) {
    return sign * (forward_kinematics(model, q).translation() - centre).norm();
  };
  const auto ends = descents(model, false, random, cost);
  std::vector<JointVector> postures;
  for (int i = 0; i < count; ++i) {
    const auto& end = ends[static_cast<std::size_t>(i) % ends.size()];
    postures.push_back(varied(model, false, end.q, random, cost));
  }
  return postures;
}

}  // namespace armature::ik_contract
