// SPDX-License-Identifier: Apache-2.0
#include "armature/calibration/hand_eye_fit.hpp"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>

#include "armature/robot/rotation_vector.hpp"

namespace armature {
namespace {

using Eigen::Isometry3d;
using Eigen::Matrix3d;
using Eigen::Vector3d;
using Matrix12 = Eigen::Matrix<double, 12, 12>;
using Vector12 = Eigen::Matrix<double, 12, 1>;
using Residual = HandEyeFit::Residual;

/// Rows: the shift and the turn of a residual. Columns: shift and turn of flange_T_body along the
/// flange's axes, shift and turn of base_T_tracker along those of the base.
using Rows = Eigen::Matrix<double, 6, 12>;

Isometry3d predicted(const RobotWorld& estimate, const HandEyePose& pose) {
  return estimate.base_T_tracker.inverse(Eigen::Isometry) * pose.base_T_flange *
         estimate.flange_T_body;
}

Residual residual_of(const RobotWorld& estimate, const HandEyePose& pose) {
  const Isometry3d tracker_T_body = predicted(estimate, pose);
  const Matrix3d turn = tracker_T_body.linear() * pose.tracker_T_body.linear().transpose();
  return {tracker_T_body.translation() - pose.tracker_T_body.translation(),
          rotation_vector_of(Eigen::Quaterniond{turn}.normalized())};
}

Matrix3d cross(const Vector3d& v) {
  Matrix3d matrix;
  matrix << 0, -v.z(), v.y(), v.z(), 0, -v.x(), -v.y(), v.x(), 0;
  return matrix;
}

Rows slope_at(const RobotWorld& estimate, const HandEyePose& pose, const Residual& residual) {
  const Matrix3d tracker_R_base = estimate.base_T_tracker.linear().transpose();
  const Matrix3d tracker_R_flange = tracker_R_base * pose.base_T_flange.linear();
  const RotationAt turn{residual.turn};
  Rows rows = Rows::Zero();
  rows.block<3, 3>(0, 0) = tracker_R_flange;
  rows.block<3, 3>(0, 6) = -tracker_R_base;
  rows.block<3, 3>(0, 9) = cross(predicted(estimate, pose).translation()) * tracker_R_base;
  for (int axis = 0; axis < 3; ++axis) {
    rows.block<3, 1>(3, 3 + axis) = turn.rate_of(tracker_R_flange.col(axis));
    rows.block<3, 1>(3, 9 + axis) = turn.rate_of(-tracker_R_base.col(axis));
  }
  return rows;
}

Isometry3d moved(const Isometry3d& pose, const Vector3d& shift, const Vector3d& turn) {
  Isometry3d result = pose;
  result.linear() = (rotation_of(turn) * Eigen::Quaterniond{pose.linear()}).normalized().matrix();
  result.translation() += shift;
  return result;
}

RobotWorld moved(const RobotWorld& estimate, const Vector12& step) {
  return {moved(estimate.flange_T_body, step.segment<3>(0), step.segment<3>(3)),
          moved(estimate.base_T_tracker, step.segment<3>(6), step.segment<3>(9))};
}

/// The problem with its weights.
class Fit {
 public:
  Fit(std::span<const HandEyePose> poses, const PoseNoise& noise) : poses_{poses}, noise_{noise} {}

  double cost(const RobotWorld& estimate) const {
    double sum = 0;
    for (const HandEyePose& pose : poses_)
      sum += weighed(residual_of(estimate, pose)).squaredNorm();
    return sum;
  }

  /// The normal equations at `estimate`.
  struct Normal {
    Matrix12 matrix = Matrix12::Zero();
    Vector12 gradient = Vector12::Zero();
  };
  Normal normal(const RobotWorld& estimate) const {
    Normal normal;
    for (const HandEyePose& pose : poses_) {
      const Residual residual = residual_of(estimate, pose);
      const Rows rows = weighed(slope_at(estimate, pose, residual));
      normal.matrix += rows.transpose() * rows;
      normal.gradient += rows.transpose() * weighed(residual);
    }
    return normal;
  }

  Expected<RobotWorld> settle(RobotWorld estimate) const {
    constexpr int kSteps = 100;
    constexpr double kSettled = 1e-13;  // [m], [rad]
    double damping = 1e-6, least = cost(estimate);
    for (int i = 0; i < kSteps; ++i) {
      Normal here = normal(estimate);
      here.matrix.diagonal() *= 1 + damping;
      const Vector12 step = -here.matrix.ldlt().solve(here.gradient);
      const RobotWorld next = moved(estimate, step);
      const double reached = cost(next);
      if (reached < least) {
        estimate = next;
        least = reached;
        damping = std::max(0.1 * damping, 1e-12);
      } else {
        damping *= 10;
      }
      if (!step.allFinite()) break;
      if (step.cwiseAbs().maxCoeff() < kSettled) return estimate;
    }
    return refuse("the poses determine nothing: the best fit does not settle");
  }

  Eigen::Matrix<double, 6, 1> weighed(const Residual& residual) const {
    Eigen::Matrix<double, 6, 1> result;
    result << residual.shift / noise_.position_m, residual.turn / noise_.rotation_rad;
    return result;
  }
  Rows weighed(Rows rows) const {
    rows.topRows<3>() /= noise_.position_m;
    rows.bottomRows<3>() /= noise_.rotation_rad;
    return rows;
  }

 private:
  std::span<const HandEyePose> poses_;
  PoseNoise noise_;
};

HandEyeFit told(std::span<const HandEyePose> poses, const RobotWorld& found,
                const PoseNoise& noise) {
  const Fit fit{poses, noise};
  HandEyeFit result{found, noise, {}, {}, {}};
  result.covariance = fit.normal(found).matrix.ldlt().solve(Matrix12::Identity());
  const double whole = fit.cost(found);
  for (const HandEyePose& pose : poses) {
    const Residual residual = residual_of(found, pose);
    result.residuals.push_back(residual);
    // Without the pose it is missed by (1 - leverage)^-1 of what it is missed by with it.
    const Rows rows = fit.weighed(slope_at(found, pose, residual));
    const Eigen::Matrix<double, 6, 6> free =
        Eigen::Matrix<double, 6, 6>::Identity() - rows * result.covariance * rows.transpose();
    const Eigen::Matrix<double, 6, 1> apart = free.ldlt().solve(fit.weighed(residual));
    const double taken = fit.weighed(residual).dot(apart);
    result.deletions.push_back({whole > 0 ? std::clamp(1 - taken / whole, 0.0, 1.0) : 1.0,
                                std::max(apart.head<3>().norm() * noise.position_m,
                                         apart.tail<3>().norm() * noise.rotation_rad)});
  }
  return result;
}

/// What the residuals show of the noise: sum of squares over redundancy, of shifts and of turns.
PoseNoise shown_by(std::span<const HandEyePose> poses, const HandEyeFit& fit) {
  const Fit weights{poses, fit.noise};
  double shifts = 0, turns = 0, free_shifts = 0, free_turns = 0;
  for (std::size_t i = 0; i < poses.size(); ++i) {
    const Residual& residual = fit.residuals[i];
    const Rows rows = weights.weighed(slope_at(fit.found, poses[i], residual));
    const auto leverage = (rows * fit.covariance * rows.transpose()).eval().diagonal();
    shifts += residual.shift.squaredNorm();
    turns += residual.turn.squaredNorm();
    free_shifts += 3 - leverage.head<3>().sum();
    free_turns += 3 - leverage.tail<3>().sum();
  }
  // Rounding, if nothing else. The length that is in no body's reach keeps few poses from giving
  // all weight to one of the two.
  constexpr double kRounding = 1e-14, kShortest = 0.005, kLongest = 5;  // [rad], [m/rad]
  const double turn = std::max(std::sqrt(turns / free_turns), kRounding);
  const double shift = std::sqrt(shifts / free_shifts);
  return {std::clamp(shift, kShortest * turn, kLongest * turn), turn};
}

}  // namespace

Expected<HandEyeFit> fit_hand_eye(std::span<const HandEyePose> poses, const RobotWorld& start,
                                  const std::optional<PoseNoise>& stated) {
  constexpr int kRounds = 50;
  constexpr double kAgreed = 1e-3, kUsualLength = 0.1;  // relative, [m/rad]
  PoseNoise noise = stated.value_or(PoseNoise{kUsualLength, 1});
  RobotWorld estimate = start;
  for (int round = 0;; ++round) {
    const auto settled = Fit{poses, noise}.settle(estimate);
    if (!settled) return tl::unexpected{settled.error()};
    estimate = *settled;
    HandEyeFit fit = told(poses, estimate, noise);
    if (stated) return fit;
    const PoseNoise shown = shown_by(poses, fit);
    const bool agreed =
        std::abs(shown.position_m - noise.position_m) <= kAgreed * noise.position_m &&
        std::abs(shown.rotation_rad - noise.rotation_rad) <= kAgreed * noise.rotation_rad;
    if (agreed || round == kRounds) return fit;
    noise = shown;
  }
}

}  // namespace armature
