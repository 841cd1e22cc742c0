// SPDX-License-Identifier: Apache-2.0
#include "armature/calibration/pivot.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "armature/calibration/beyond_chance.hpp"
#include "armature/calibration/symmetric.hpp"
#include "armature/calibration/usable_pose.hpp"

namespace armature {
namespace {

using Eigen::Isometry3d;
using Eigen::Matrix3d;
using Eigen::Vector3d;

/// R_i tip + t_i = point, without the point: (R_i - mean R) tip = -(t_i - mean t).
struct Equations {
  std::span<const Isometry3d> poses;
  Matrix3d mean_rotation = Matrix3d::Zero();
  Vector3d mean_position = Vector3d::Zero();
  Matrix3d normal = Matrix3d::Zero();

  explicit Equations(std::span<const Isometry3d> all) : poses{all} {
    const double n = static_cast<double>(all.size());
    for (const Isometry3d& pose : all) {
      mean_rotation += pose.linear() / n;
      mean_position += pose.translation() / n;
    }
    for (const Isometry3d& pose : all) {
      const Matrix3d row = pose.linear() - mean_rotation;
      normal += row.transpose() * row;
    }
  }
  Vector3d tip() const {
    Vector3d right = Vector3d::Zero();
    for (const Isometry3d& pose : poses) {
      right -= (pose.linear() - mean_rotation).transpose() * (pose.translation() - mean_position);
    }
    return solve_symmetric(normal, right);
  }
  /// By which the body turns, seen from the axis it is seen worst from: turns by w move the tip by
  /// w x tip, so the least eigenvalue is the mean square of the turns about the two other axes.
  double spread() const {
    return std::sqrt(smallest_singular_value(normal) / static_cast<double>(poses.size()));
  }
};

std::vector<Vector3d> residuals_of(std::span<const Isometry3d> poses, const Pivot& found) {
  std::vector<Vector3d> residuals;
  for (const Isometry3d& pose : poses) residuals.push_back(pose * found.tip - found.point);
  return residuals;
}

void measure_residuals(const std::vector<Vector3d>& residuals, Pivot& found) {
  double squares = 0;
  for (std::size_t i = 0; i < residuals.size(); ++i) {
    const double off = residuals[i].norm();
    squares += off * off;
    if (off <= found.worst_m) continue;
    found.worst_m = off;
    found.worst_pose = i;
  }
  found.residual_rms_m = std::sqrt(squares / static_cast<double>(residuals.size()));
}

/// Of the tip, when the residuals told in the body's frame have one covariance.
Matrix3d tip_covariance(const Equations& equations, const std::vector<Vector3d>& residuals) {
  const double n = static_cast<double>(residuals.size());
  Matrix3d body = Matrix3d::Zero();
  for (std::size_t i = 0; i < residuals.size(); ++i) {
    const Vector3d off = equations.poses[i].linear().transpose() * residuals[i];
    body += off * off.transpose() / (n - 2);  // six unknowns, three equations a pose
  }
  Matrix3d passed_on = Matrix3d::Zero();
  for (const Isometry3d& pose : equations.poses) {
    const Matrix3d gain = (pose.linear() - equations.mean_rotation).transpose() * pose.linear();
    passed_on += gain * body * gain.transpose();
  }
  const Matrix3d inverse = equations.normal.inverse();
  return inverse * passed_on * inverse;
}

/// The pose that the others contradict, to be read as a reason.
std::optional<std::string> outlying(const Equations& equations,
                                    const std::vector<Vector3d>& residuals) {
  constexpr double kMinMisfit = 1e-6;  // [m]; rounding is not normal
  const double n = static_cast<double>(residuals.size());
  const double freedom = 3 * n - 9;  // of the others
  if (freedom < 1) return std::nullopt;
  const Matrix3d inverse = equations.normal.inverse();
  double whole = 0, most = -1, off = 0;
  std::size_t suspect = 0;
  for (std::size_t i = 0; i < residuals.size(); ++i) {
    whole += residuals[i].squaredNorm();
    const Matrix3d row = equations.poses[i].linear() - equations.mean_rotation;
    const Matrix3d free = (1 - 1 / n) * Matrix3d::Identity() - row * inverse * row.transpose();
    const Vector3d apart = solve_symmetric(free, residuals[i]);  // missed by the others' tip
    const double taken = residuals[i].dot(apart);
    if (taken <= most) continue;
    most = taken;
    off = apart.norm();
    suspect = i;
  }
  const double others = std::max(whole - most, 0.0);
  if (off <= kMinMisfit) return std::nullopt;
  if (!beyond_chance({most / 3 / (others / freedom), 3, freedom}, residuals.size())) {
    return std::nullopt;
  }
  return fmt::format("pose {} does not fit the others: its tip is {:.3g} mm off; did the tip slip?",
                     suspect + 1, millimetres(off));
}

}  // namespace

Expected<Pivot> calibrate_pivot(std::span<const Isometry3d> fixed_T_body,
                                const PivotOptions& options) {
  constexpr std::size_t kMinPoses = 3;
  const std::size_t n = fixed_T_body.size();
  if (n < kMinPoses) {
    return refuse(fmt::format("{} poses, at least {} are needed", n, kMinPoses));
  }
  for (std::size_t i = 0; i < n; ++i) {
    if (const auto wrong = wrong_with(fixed_T_body[i])) {
      return refuse(fmt::format("pose {} {}", i + 1, *wrong));
    }
    for (std::size_t k = 0; k < i; ++k) {
      if (fixed_T_body[k].matrix() == fixed_T_body[i].matrix()) return refuse(said_twice(k, i));
    }
  }
  const Equations equations{fixed_T_body};
  Pivot found;
  found.spread_rad = equations.spread();
  if (!(found.spread_rad >= options.min_spread_rad)) {
    return refuse(fmt::format(
        "the body hardly turns, or about one axis only: by {:.1f} deg rms about the others, at "
        "least {:.1f} deg are needed",
        degrees(found.spread_rad), degrees(options.min_spread_rad)));
  }
  found.tip = equations.tip();
  found.point = equations.mean_rotation * found.tip + equations.mean_position;
  const std::vector<Vector3d> residuals = residuals_of(fixed_T_body, found);
  measure_residuals(residuals, found);
  if (auto stranger = outlying(equations, residuals)) return refuse(std::move(*stranger));
  if (found.residual_rms_m > options.max_residual_m) {
    return refuse(
        fmt::format("the tip did not stand still: {:.3g} mm rms remain, at most {:.3g} mm",
                    millimetres(found.residual_rms_m), millimetres(options.max_residual_m)));
  }
  if (!(found.tip.norm() <= options.longest_tool_m)) {
    return refuse(fmt::format(
        "the tip lies {:.3g} m from the body's origin, at most {:g} m; is a transform the wrong "
        "way round, or a unit wrong?",
        found.tip.norm(), options.longest_tool_m));
  }
  found.tip_error = point_error(tip_covariance(equations, residuals));
  return found;
}

}  // namespace armature
