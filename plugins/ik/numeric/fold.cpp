// SPDX-License-Identifier: Apache-2.0
#include "fold.hpp"

#include <algorithm>
#include <cmath>

#include "armature/robot/kinematics/kinematics.hpp"
#include "armature/robot/kinematics/singular_values.hpp"

namespace armature::ik::numeric {
namespace {

using Vector6 = Eigen::Matrix<double, 6, 1>;

constexpr double kApart = 1e-5;   // [rad] or [m] between the Jacobians that tell a curvature
constexpr double kLongest = 1.0;  // [rad] or [m], of any joint
constexpr double kFlat = 1e-8;    // of the largest curvature: less is what that leaves unknown

Jacobian jacobian_at(const RobotModel& model, const JointVector& q) {
  return forward_kinematics_with_jacobian(model, q, model.tool()).jacobian;
}

/// What is missing to the goal, and how the joints that are not fixed change it. Of a pointing goal
/// a turn about the pointing axis is left out.
struct Missing {
  Vector6 error;
  Jacobian jacobian;

  Missing(const RobotModel& model, const IkGoal& goal, descent::JointSet fixed,
          const JointVector& q)
      : jacobian{jacobian_at(model, q)} {
    const Eigen::Isometry3d pose = forward_kinematics(model, q);
    error.head<3>() = goal.pose.position - pose.translation();
    if (const auto* direction = std::get_if<Direction>(&goal.pose.orientation)) {
      const Eigen::Vector3d axis = pose.linear() * *model.pointing_axis();
      error.tail<3>() = axis.cross(direction->unit.normalized());
      for (int j = 0; j < model.dof(); ++j) {
        auto turn = jacobian.col(j).tail<3>();
        turn -= axis.dot(turn) * axis;
      }
    } else {
      const auto& wanted = std::get<Eigen::Quaterniond>(goal.pose.orientation);
      const Eigen::Quaterniond turn =
          wanted.normalized() * Eigen::Quaterniond{pose.linear()}.conjugate();
      error.tail<3>() = std::copysign(2.0, turn.w()) * turn.vec();
    }
    for (int j = 0; j < model.dof(); ++j) {
      if (fixed >> j & 1) jacobian.col(j).setZero();
    }
  }
};

/// How the motion of the tool in direction `across` bends when the joints move along the columns
/// of `along`: second derivatives.
SmallMatrix curvature_at(const RobotModel& model, const JointVector& q, const Vector6& across,
                         const SmallMatrix& along) {
  SmallMatrix curvature(along.cols(), along.cols());
  for (Eigen::Index i = 0; i < along.cols(); ++i) {
    const JointVector way = 0.5 * kApart * along.col(i);
    const SmallVector bent =
        (jacobian_at(model, q + way) - jacobian_at(model, q - way)).transpose() * across / kApart;
    curvature.col(i) = along.transpose() * bent;
  }
  const SmallMatrix other = curvature.transpose();  // turns do not commute: the mean is what counts
  return 0.5 * (curvature + other);
}

}  // namespace

std::optional<JointVector> fold_step(const RobotModel& model, const IkGoal& goal,
                                     descent::JointSet fixed, const JointVector& q) {
  const int last = std::holds_alternative<Direction>(goal.pose.orientation) ? 4 : 5;
  if (model.dof() <= last) return std::nullopt;
  const Missing missing{model, goal, fixed, q};
  const SingularValues moves{missing.jacobian};
  const Vector6 across = moves.left.col(last).head<6>();
  SmallMatrix along = moves.right.block(0, last, model.dof(), model.dof() - last);
  for (int j = 0; j < model.dof(); ++j) {
    if (fixed >> j & 1) along.row(j).setZero();
  }

  // The step along * z takes away slope z_0 + z^T curvature z / 2, at its vertex the most: depth.
  const double slope = moves.values[last], error = across.dot(missing.error);
  const SingularValues bends{curvature_at(model, q, across, along)};
  SmallVector vertex = SmallVector::Zero(along.cols());
  for (Eigen::Index i = 0; i < along.cols() && bends.values[i] > kFlat * bends.values[0]; ++i) {
    vertex -= slope * bends.left(0, i) / bends.values[i] * bends.right.col(i);
  }
  const double depth = 0.5 * slope * vertex[0];
  if (!(error * depth > 0)) return std::nullopt;
  // Level sets are copies of each other about the vertex, as large as the root of what is left.
  const double size = std::sqrt(std::max(1 - error / depth, 0.0));
  const JointVector step = (1 - size) * (along * vertex);
  return JointVector{step / std::max(1.0, step.cwiseAbs().maxCoeff() / kLongest)};
}

}  // namespace armature::ik::numeric
