// SPDX-License-Identifier: Apache-2.0
#include "view_agreement.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <Eigen/Cholesky>
#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

namespace armature::host::target {
namespace {

using Eigen::Matrix3d, Eigen::Vector3d;

constexpr std::size_t kLooks = 3;                       // at rest make a view
constexpr double kRests_m = 0.5e-3, kRests_rad = 1e-3;  // of the camera
constexpr double kFarther_m = 0.1, kSoon_s = 10;        // between the views of a pair
constexpr std::size_t kFewest = 5, kMemory = 20;        // pairs
constexpr double kStirs_m = 0.003;                      // people, at least
constexpr double kSure = 5;                             // standard deviations
constexpr double kTold_m = 0.004;                       // less may be the finder of the landmarks

struct Cause {
  const char* words;
  double told;  // of one
};
constexpr double kDegrees = 180 / std::numbers::pi;
constexpr std::array<Cause, 6> kCauses{{{"degrees of yaw between the cameras", kDegrees},
                                        {"% of both focal lengths", 100},
                                        {"% of the baseline", 100},
                                        {"degrees of the rig about its rows", kDegrees},
                                        {"degrees of the rig about its columns", kDegrees},
                                        {"degrees of the rig about its line of sight", kDegrees}}};

/// By how much one of each cause has a face elsewhere that is at `x` in the left camera's frame.
Eigen::Matrix<double, 3, 6> by_cause(const Vector3d& x, double baseline_m) {
  Eigen::Matrix<double, 3, 6> by;
  by << x * (x.z() / baseline_m), Vector3d{0, 0, x.z()}, x, Vector3d::UnitX().cross(x),
      Vector3d::UnitY().cross(x), Vector3d::UnitZ().cross(x);
  return by;
}

/// The middle one of each coordinate.
Vector3d median(const std::vector<TargetMeasurement>& looks) {
  Vector3d middle;
  for (int axis = 0; axis < 3; ++axis) {
    std::array<double, kLooks> sorted{};
    std::ranges::transform(looks, sorted.begin(),
                           [&](const TargetMeasurement& m) { return m.position[axis]; });
    std::ranges::sort(sorted);
    middle[axis] = sorted[kLooks / 2];
  }
  return middle;
}

}  // namespace

void ViewAgreement::add(const Eigen::Isometry3d& base_T_left, const TargetMeasurement& measured) {
  if (!measured.position.allFinite() || !measured.position_covariance.allFinite()) return;
  const Eigen::Isometry3d moved = rests_at_.inverse() * base_T_left;
  if (moved.translation().norm() > kRests_m ||
      Eigen::AngleAxisd{moved.linear()}.angle() > kRests_rad) {
    looks_.clear();
    rests_at_ = base_T_left;
  }
  if (looks_.size() == kLooks) return;
  looks_.push_back(measured);
  if (looks_.size() < kLooks) return;
  View view{.face = measured, .base_T_left = base_T_left};
  view.face.position = median(looks_);
  view.face.position_covariance /= kLooks;
  take(view);
}

void ViewAgreement::take(const View& view) {
  const bool makes_pair =
      last_ && to_seconds(view.face.stamp - last_->face.stamp) < kSoon_s &&
      (view.base_T_left.translation() - last_->base_T_left.translation()).norm() > kFarther_m;
  if (!makes_pair) {
    last_ = view;
    return;
  }
  const auto by = [&](const View& one) -> Eigen::Matrix<double, 3, 6> {
    return one.base_T_left.linear() *
           by_cause(one.base_T_left.inverse() * one.face.position, baseline_m_);
  };
  pairs_.push_back({.apart = last_->face.position - view.face.position,
                    .covariance = last_->face.position_covariance + view.face.position_covariance,
                    .by_cause = by(*last_) - by(view)});
  last_.reset();  // what a view errs by counts once
  if (pairs_.size() > kMemory) pairs_.pop_front();
  const std::string told = pairs_.size() < kFewest ? "" : causes();
  warning_ = told.empty() ? ""
                          : fmt::format(
                                "in {} approaches the face was elsewhere from near than from afar, "
                                "and by the same: {}; calibrate the cameras again, and measure "
                                "where they hang",
                                pairs_.size(), told);
}

std::string ViewAgreement::causes() const {
  std::vector<std::string> told;
  for (std::size_t cause = 0; cause < kCauses.size(); ++cause) {
    const auto column = static_cast<Eigen::Index>(cause);
    double size = 0, information = 0, shift = 0, variance = kStirs_m * kStirs_m;
    for (int pass = 0; pass < 3; ++pass) {
      double sum = 0, squares = 0;
      information = 0;
      for (const Pair& pair : pairs_) {
        const Matrix3d noise = pair.covariance + variance * Matrix3d::Identity();
        const Vector3d weighted = noise.llt().solve(pair.by_cause.col(column));
        sum += weighted.dot(pair.apart);
        information += weighted.dot(pair.by_cause.col(column));
      }
      size = sum / information;
      shift = 0;
      for (const Pair& pair : pairs_) {
        const Vector3d explained = size * pair.by_cause.col(column);
        squares += (pair.apart - explained).squaredNorm() / 3;
        shift += explained.norm();
      }
      const auto count = static_cast<double>(pairs_.size());
      shift /= count;
      variance = std::max(kStirs_m * kStirs_m, squares / count);
    }
    if (!(std::abs(size) * std::sqrt(information) > kSure && shift > kTold_m)) continue;
    told.push_back(
        fmt::format("{:.2g} {}", std::abs(size) * kCauses[cause].told, kCauses[cause].words));
  }
  return told.empty() ? "" : fmt::format("{} would explain it", fmt::join(told, ", or "));
}

}  // namespace armature::host::target
