// SPDX-License-Identifier: Apache-2.0
#include "armature/calibration/hand_eye_fit.hpp"

#include <algorithm>
#include <cmath>

#include "armature/calibration/symmetric.hpp"
#include "armature/robot/geometry/rotation_vector.hpp"
#include "armature/robot/orientations/rotation_at.hpp"

namespace armature {
namespace {

using Eigen::Isometry3d;
using Eigen::Matrix3d;
using Eigen::Vector3d;

/// 6 x 12. Rows: the shift and the turn of a residual. Columns: shift and turn of flange_T_body
/// along the flange's axes, shift and turn of base_T_tracker along those of the base.
using Rows = SmallMatrix;

Isometry3d predicted(const RobotWorld& estimate, const HandEyePose& pose) {
  return estimate.base_T_tracker.inverse(Eigen::Isometry) * pose.base_T_flange *
         estimate.flange_T_body;
}

PoseResidual residual_of(const RobotWorld& estimate, const HandEyePose& pose) {
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

Rows slope_at(const RobotWorld& estimate, const HandEyePose& pose, const PoseResidual& residual) {
  const Matrix3d tracker_R_base = estimate.base_T_tracker.linear().transpose();
  const Matrix3d tracker_R_flange = tracker_R_base * pose.base_T_flange.linear();
  const RotationAt turn{residual.turn};
  Rows rows = Rows::Zero(6, 12);
  rows.block<3, 3>(0, 0) = tracker_R_flange;
  rows.block<3, 3>(0, 6) = -tracker_R_base;
  rows.block<3, 3>(0, 9) = cross(predicted(estimate, pose).translation()) * tracker_R_base;
  for (int axis = 0; axis < 3; ++axis) {
    rows.block<3, 1>(3, 3 + axis) = turn.rate_of(tracker_R_flange.col(axis));
    rows.block<3, 1>(3, 9 + axis) = turn.rate_of(-tracker_R_base.col(axis));
  }
  return rows;
}

/// The covariance of `rows` times a vector that has `covariance`.
SmallMatrix covariance_through(const Rows& rows, const SmallMatrix& covariance) {
  const SmallMatrix half = rows.lazyProduct(covariance);
  return half.lazyProduct(rows.transpose());
}

Isometry3d moved(const Isometry3d& pose, const Vector3d& shift, const Vector3d& turn) {
  Isometry3d result = pose;
  result.linear() = (rotation_of(turn) * Eigen::Quaterniond{pose.linear()}).normalized().matrix();
  result.translation() += shift;
  return result;
}

RobotWorld moved(const RobotWorld& estimate, const SmallVector& step) {
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
    SmallMatrix matrix = SmallMatrix::Zero(12, 12);
    SmallVector gradient = SmallVector::Zero(12);
  };
  Normal normal(const RobotWorld& estimate) const {
    Normal normal;
    for (const HandEyePose& pose : poses_) {
      const PoseResidual residual = residual_of(estimate, pose);
      const Rows rows = weighed(slope_at(estimate, pose, residual));
      normal.matrix += rows.transpose().lazyProduct(rows);
      normal.gradient += rows.transpose().lazyProduct(weighed(residual));
    }
    return normal;
  }

  /// Where the steps end: at the best fit, or with poses that contradict each other near it.
  Expected<RobotWorld> settle(RobotWorld estimate) const {
    constexpr int kSteps = 100;
    constexpr double kSettled = 1e-13;  // [m], [rad]
    double damping = 1e-6, least = cost(estimate);
    for (int i = 0; i < kSteps; ++i) {
      Normal here = normal(estimate);
      here.matrix.diagonal() *= 1 + damping;
      const SmallVector step = -solve_symmetric(here.matrix, here.gradient);
      if (!step.allFinite()) return refuse("the poses determine nothing: no step is finite");
      const RobotWorld next = moved(estimate, step);
      const double reached = cost(next);
      if (reached < least) {
        estimate = next;
        least = reached;
        damping = std::max(0.1 * damping, 1e-12);
      } else {
        damping *= 10;
      }
      if (step.cwiseAbs().maxCoeff() < kSettled) break;
    }
    return estimate;
  }

  SmallVector weighed(const PoseResidual& residual) const {
    SmallVector result(6);
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

/// The one more parameter u of the fit whose shifts are predicted - u measured: at the best fit for
/// u = 1 the residuals lie square to all slopes, so that what is left of its own slope beside them
/// tells it (the score test; C. R. Rao, Proc. Cambridge Phil. Soc. 44, 1948).
TrackerScale scale_of(std::span<const HandEyePose> poses, const HandEyeFit& fit,
                      const Fit& weights) {
  const auto own_slope = [&](const HandEyePose& pose) {
    return weights.weighed(PoseResidual{.shift = -pose.tracker_T_body.translation()});
  };
  const auto shared_slope = [&](std::size_t i) {
    return weights.weighed(slope_at(fit.found, poses[i], fit.residuals[i]));
  };
  SmallVector shared = SmallVector::Zero(12);
  double own = 0, along = 0;
  for (std::size_t i = 0; i < poses.size(); ++i) {
    const SmallVector slope = own_slope(poses[i]);
    shared += shared_slope(i).transpose().lazyProduct(slope);
    own += slope.squaredNorm();
    along += slope.dot(weights.weighed(fit.residuals[i]));
  }
  const SmallVector others = fit.covariance.lazyProduct(shared);
  const double left = own - shared.dot(others);
  constexpr double kLeast = 1e-6;  // of the slope: with less, no scale shows
  TrackerScale scale;
  scale.freedom = fit.shift_freedom - 1;
  if (left < kLeast * own || scale.freedom < 1) return scale;
  const double step = -along / left;
  double remaining = 0;
  for (std::size_t i = 0; i < poses.size(); ++i) {
    SmallVector residual = weights.weighed(fit.residuals[i]) + step * own_slope(poses[i]);
    residual -= step * shared_slope(i).lazyProduct(others);
    remaining += residual.head<3>().squaredNorm();
  }
  scale.value = 1 / (1 + step);
  scale.ratio = along * along / left / (remaining / scale.freedom);
  return scale;
}

/// What the poses tell at their best fit.
HandEyeFit told(std::span<const HandEyePose> poses, const RobotWorld& found,
                const PoseNoise& noise) {
  const Fit fit{poses, noise};
  HandEyeFit result;
  result.found = found;
  result.noise = noise;
  result.covariance = solve_symmetric(fit.normal(found).matrix, SmallMatrix::Identity(12, 12));
  double most = -1;
  for (std::size_t i = 0; i < poses.size(); ++i) {
    const PoseResidual residual = residual_of(found, poses[i]);
    const Rows rows = fit.weighed(slope_at(found, poses[i], residual));
    const SmallMatrix leverage = covariance_through(rows, result.covariance);
    result.residuals.push_back(residual);
    result.shift_freedom += 3 - leverage.diagonal().head<3>().sum();
    result.turn_freedom += 3 - leverage.diagonal().tail<3>().sum();
    const SmallVector apart =
        solve_symmetric(SmallMatrix::Identity(6, 6) - leverage, fit.weighed(residual));
    const double taken = fit.weighed(residual).dot(apart);
    if (taken <= most) continue;
    most = taken;
    result.suspect = i;
  }
  result.scale = scale_of(poses, result, fit);
  return result;
}

/// What the residuals show of the noise: sum of squares over redundancy, of shifts and of turns. Of
/// two that are too far apart the smaller one is told larger, never the larger one smaller: nobody
/// is to be accused, or reassured, by less noise than there is.
PoseNoise shown_by(const HandEyeFit& fit) {
  double shifts = 0, turns = 0;
  for (const PoseResidual& residual : fit.residuals) {
    shifts += residual.shift.squaredNorm();
    turns += residual.turn.squaredNorm();
  }
  // Rounding, if nothing else, and hardly an equation left over. The lengths, which no body has,
  // keep few poses from giving all weight to one of the two.
  constexpr double kRounding = 1e-14, kMinFreedom = 1e-3, kShortest = 0.005,
                   kLongest = 5;  // [rad], [m/rad]
  const double turn =
      std::max(std::sqrt(turns / std::max(fit.turn_freedom, kMinFreedom)), kRounding);
  const double shift = std::sqrt(shifts / std::max(fit.shift_freedom, kMinFreedom));
  return {std::max(shift, kShortest * turn), std::max(turn, shift / kLongest)};
}

}  // namespace

Expected<HandEyeFit> fit_hand_eye(std::span<const HandEyePose> poses,
                                  const std::optional<PoseNoise>& stated) {
  constexpr int kRounds = 50;
  constexpr double kAgreed = 1e-3, kUsualLength = 0.1;  // relative, [m/rad]
  PoseNoise noise = stated.value_or(PoseNoise{kUsualLength, 1});
  RobotWorld estimate = solve_robot_world(poses);
  for (int round = 0;; ++round) {
    const auto settled = Fit{poses, noise}.settle(estimate);
    if (!settled) return tl::unexpected{settled.error()};
    estimate = *settled;
    HandEyeFit fit = told(poses, estimate, noise);
    if (stated) return fit;
    const PoseNoise shown = shown_by(fit);
    const bool agreed =
        std::abs(shown.position_m - noise.position_m) <= kAgreed * noise.position_m &&
        std::abs(shown.rotation_rad - noise.rotation_rad) <= kAgreed * noise.rotation_rad;
    if (agreed || round == kRounds) return fit;
    noise = shown;
  }
}

Misfit misfit_of(const HandEyePose& pose, const HandEyeFit& fit) {
  Misfit misfit{residual_of(fit.found, pose), 0, 0};
  const Rows rows = slope_at(fit.found, pose, misfit.residual);
  SmallMatrix expected = covariance_through(rows, fit.covariance);
  expected.diagonal().head<3>().array() += fit.noise.position_m * fit.noise.position_m;
  expected.diagonal().tail<3>().array() += fit.noise.rotation_rad * fit.noise.rotation_rad;
  const auto mean_square = [](const Vector3d& off, const Matrix3d& covariance) {
    return off.dot(Vector3d{solve_symmetric(covariance, off)}) / 3;
  };
  misfit.shift_ratio = mean_square(misfit.residual.shift, expected.topLeftCorner<3, 3>());
  misfit.turn_ratio = mean_square(misfit.residual.turn, expected.bottomRightCorner<3, 3>());
  return misfit;
}

}  // namespace armature
