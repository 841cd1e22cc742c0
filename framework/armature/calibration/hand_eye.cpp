// SPDX-License-Identifier: Apache-2.0
#include "armature/calibration/hand_eye.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "armature/calibration/beyond_chance.hpp"
#include "armature/calibration/hand_eye_fit.hpp"
#include "armature/calibration/usable_pose.hpp"

namespace armature {
namespace {

constexpr std::size_t kMinPoses = 3;
constexpr double kStatedFreedom = 1e6;  // of a noise that is not estimated

std::optional<std::string> wrong_with_a_pose(std::span<const HandEyePose> poses) {
  for (std::size_t i = 0; i < poses.size(); ++i) {
    if (const auto wrong = wrong_with(poses[i].base_T_flange)) {
      return fmt::format("base_T_flange of pose {} {}", i + 1, *wrong);
    }
    if (const auto wrong = wrong_with(poses[i].tracker_T_body)) {
      return fmt::format("tracker_T_body of pose {} {}", i + 1, *wrong);
    }
    for (std::size_t k = 0; k < i; ++k) {
      if (poses[k].base_T_flange.matrix() == poses[i].base_T_flange.matrix() &&
          poses[k].tracker_T_body.matrix() == poses[i].tracker_T_body.matrix()) {
        return said_twice(k, i);
      }
    }
  }
  return std::nullopt;
}

std::optional<std::string> wrong_with_the_noise(const std::optional<PoseNoise>& noise) {
  if (!noise) return std::nullopt;
  const auto usable = [](double value) { return value > 0 && std::isfinite(value); };
  if (usable(noise->position_m) && usable(noise->rotation_rad)) return std::nullopt;
  return fmt::format("the stated noise is {} m, {} rad; both must be positive", noise->position_m,
                     noise->rotation_rad);
}

Eigen::Vector3d flange_spread(std::span<const HandEyePose> poses) {
  std::vector<Eigen::Isometry3d> flanges;
  for (const HandEyePose& pose : poses) flanges.push_back(pose.base_T_flange);
  return spread_of(flanges);
}

std::optional<std::string> too_narrow(const Eigen::Vector3d& spread, double least) {
  if (spread[1] >= least) return std::nullopt;
  if (spread[0] < least) {
    return fmt::format("the flange hardly turns: by {:.1f} deg rms, at least {:.1f} deg are needed",
                       degrees(spread[0]), degrees(least));
  }
  return fmt::format(
      "the flange turns about one axis only: by {:.1f} deg rms about the next one, at least {:.1f} "
      "deg are needed",
      degrees(spread[1]), degrees(least));
}

/// Rms of the distances and of the angles.
PoseNoise rms_of(const std::vector<PoseResidual>& residuals) {
  double shifts = 0, turns = 0;
  for (const PoseResidual& residual : residuals) {
    shifts += residual.shift.squaredNorm();
    turns += residual.turn.squaredNorm();
  }
  const double n = static_cast<double>(residuals.size());
  return {std::sqrt(shifts / n), std::sqrt(turns / n)};
}

std::optional<std::string> too_far_apart(const HandEyeFit& fit, const PoseNoise& most) {
  const PoseNoise rms = rms_of(fit.residuals);
  if (rms.position_m <= most.position_m && rms.rotation_rad <= most.rotation_rad) {
    return std::nullopt;
  }
  return fmt::format(
      "the poses do not belong together: {:.3g} mm and {:.3g} deg rms remain, at most {:.3g} mm "
      "and {:.3g} deg; is a transform the wrong way round, or a unit wrong?",
      millimetres(rms.position_m), degrees(rms.rotation_rad), millimetres(most.position_m),
      degrees(most.rotation_rad));
}

/// Lengths of which the tracker and the arm have different ideas, to be read as a reason.
std::optional<std::string> scaled(const HandEyeFit& fit) {
  constexpr double kLeast = 1e-4;  // 0.1 mm in a metre, which no tracker tells
  const TrackerScale& scale = fit.scale;
  if (std::abs(scale.value - 1) < kLeast || !beyond_chance({scale.ratio, 1, scale.freedom}, 1)) {
    return std::nullopt;
  }
  return fmt::format(
      "the tracker's lengths are {:.4f} times the arm's; are the body's file and the robot's "
      "right?",
      scale.value);
}

/// What remains where a noise is stated that explains it not at all, to be read as a reason.
std::optional<std::string> beyond_stated(const HandEyeFit& fit,
                                         const std::optional<PoseNoise>& stated) {
  if (!stated) return std::nullopt;
  double shifts = 0, turns = 0;
  for (const PoseResidual& residual : fit.residuals) {
    shifts += residual.shift.squaredNorm();
    turns += residual.turn.squaredNorm();
  }
  const PoseNoise shown{std::sqrt(shifts / std::max(fit.shift_freedom, 1.0)),
                        std::sqrt(turns / std::max(fit.turn_freedom, 1.0))};
  const auto beyond = [](double shows, double says, double freedom) {
    const int equations = std::max(static_cast<int>(std::lround(freedom)), 1);
    return beyond_chance({std::pow(shows / says, 2), equations, kStatedFreedom}, 1);
  };
  if (!beyond(shown.position_m, stated->position_m, fit.shift_freedom) &&
      !beyond(shown.rotation_rad, stated->rotation_rad, fit.turn_freedom)) {
    return std::nullopt;
  }
  return fmt::format(
      "all poses together show a noise of {:.3g} mm and {:.3g} deg, more than the stated {:.3g} mm "
      "and {:.3g} deg; was the tracker knocked between them, or does more err than it?",
      millimetres(shown.position_m), degrees(shown.rotation_rad), millimetres(stated->position_m),
      degrees(stated->rotation_rad));
}

/// The pose that the others contradict, to be read as a reason.
std::optional<std::string> outlying(std::span<const HandEyePose> poses, const HandEyeFit& all,
                                    const HandEyeOptions& options) {
  constexpr double kMinMisfit = 1e-6;  // [m], [rad]; rounding is not normal
  std::vector<HandEyePose> others(poses.begin(), poses.end());
  others.erase(others.begin() + static_cast<std::ptrdiff_t>(all.suspect));
  if (others.size() < kMinPoses || flange_spread(others)[1] < options.min_spread_rad) {
    return std::nullopt;
  }
  const auto fit = fit_hand_eye(others, options.noise);
  if (!fit || too_far_apart(*fit, options.max_residual)) return std::nullopt;
  if (beyond_stated(*fit, options.noise)) return std::nullopt;  // it is not this pose alone
  const Misfit misfit = misfit_of(poses[all.suspect], *fit);
  const double shift = misfit.residual.shift.norm(), turn = misfit.residual.turn.norm();
  const auto doubtful = [&](double off, double ratio, double freedom) {
    const double known = options.noise ? kStatedFreedom : freedom;
    return off > kMinMisfit && beyond_chance({ratio, 3, known}, 2 * poses.size());
  };
  if (!doubtful(shift, misfit.shift_ratio, fit->shift_freedom) &&
      !doubtful(turn, misfit.turn_ratio, fit->turn_freedom)) {
    return std::nullopt;
  }
  return fmt::format(
      "pose {} does not fit the others: it is {:.3g} mm and {:.3g} deg off; was the "
      "arm still moving, or the body hidden?",
      all.suspect + 1, millimetres(shift), degrees(turn));
}

HandEye result_of(const HandEyeFit& fit) {
  HandEye result;
  result.flange_T_body = fit.found.flange_T_body;
  result.base_T_tracker = fit.found.base_T_tracker;
  result.noise = fit.noise;
  result.flange_T_body_covariance = fit.covariance.topLeftCorner<6, 6>();
  result.base_T_tracker_covariance = fit.covariance.bottomRightCorner<6, 6>();
  result.cross_covariance = fit.covariance.topRightCorner<6, 6>();
  const PoseNoise rms = rms_of(fit.residuals);
  result.residual_rms_m = rms.position_m;
  result.residual_rms_rad = rms.rotation_rad;
  double worst = -1;
  for (std::size_t i = 0; i < fit.residuals.size(); ++i) {
    const double shift = fit.residuals[i].shift.norm(), turn = fit.residuals[i].turn.norm();
    const double off = std::hypot(shift / fit.noise.position_m, turn / fit.noise.rotation_rad);
    if (off <= worst) continue;
    worst = off;
    result.worst_pose = i;
    result.worst_m = shift;
    result.worst_rad = turn;
  }
  return result;
}

/// By which a point of b moves that lies at `arm` from its origin, along a, with a_T_b.
Eigen::Matrix<double, 3, 6> slope_at_end_of(const Eigen::Vector3d& arm) {
  Eigen::Matrix<double, 3, 6> slope;
  slope.leftCols<3>().setIdentity();
  for (int axis = 0; axis < 3; ++axis) {
    slope.col(3 + axis) = Eigen::Vector3d::Unit(axis).cross(arm);
  }
  return slope;
}

}  // namespace

PointError HandEye::error_at(const Eigen::Vector3d& point_in_base) const {
  const auto slope = slope_at_end_of(point_in_base - base_T_tracker.translation());
  return point_error(slope * base_T_tracker_covariance * slope.transpose());
}

PointError HandEye::body_error_at(const Eigen::Vector3d& point_in_flange) const {
  const auto slope = slope_at_end_of(point_in_flange - flange_T_body.translation());
  return point_error(slope * flange_T_body_covariance * slope.transpose());
}

PointError HandEye::guided_error_at(const Eigen::Vector3d& point_in_flange,
                                    const Eigen::Isometry3d& base_T_flange) const {
  const Eigen::Vector3d point_in_base = base_T_flange * point_in_flange;
  const Eigen::Matrix<double, 3, 6> body =
      base_T_flange.linear() * slope_at_end_of(point_in_flange - flange_T_body.translation());
  const auto tracker = slope_at_end_of(point_in_base - base_T_tracker.translation());
  const Eigen::Matrix3d common = body * cross_covariance * tracker.transpose();
  return point_error(body * flange_T_body_covariance * body.transpose() +
                     tracker * base_T_tracker_covariance * tracker.transpose() - common -
                     common.transpose());
}

Expected<HandEye> calibrate_hand_eye(std::span<const HandEyePose> poses,
                                     const HandEyeOptions& options) {
  if (poses.size() < kMinPoses) {
    return refuse(fmt::format("{} poses, at least {} are needed", poses.size(), kMinPoses));
  }
  if (auto wrong = wrong_with_a_pose(poses)) return refuse(std::move(*wrong));
  if (auto wrong = wrong_with_the_noise(options.noise)) return refuse(std::move(*wrong));
  const Eigen::Vector3d spread = flange_spread(poses);
  if (auto narrow = too_narrow(spread, options.min_spread_rad)) return refuse(std::move(*narrow));

  const auto fit = fit_hand_eye(poses, options.noise);
  if (!fit) return tl::unexpected{fit.error()};
  if (auto apart = too_far_apart(*fit, options.max_residual)) {
    auto stranger = outlying(poses, *fit, options);
    return refuse(std::move(stranger ? *stranger : *apart));
  }
  if (auto longer = scaled(*fit)) return refuse(std::move(*longer));
  if (auto stranger = outlying(poses, *fit, options)) return refuse(std::move(*stranger));
  if (auto more = beyond_stated(*fit, options.noise)) return refuse(std::move(*more));
  HandEye result = result_of(*fit);
  result.spread_rad = spread[1];
  return result;
}

}  // namespace armature
