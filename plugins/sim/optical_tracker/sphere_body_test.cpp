// SPDX-License-Identifier: Apache-2.0
// How well a tracker knows a body of spheres.
#include "sphere_body.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace armature::sim::optical_tracker {
namespace {

using Eigen::Vector3d;

const std::vector<Vector3d> kSpheres{{0, 0, 0}, {0.05, 0, 0}, {0, 0.042, 0}, {0.038, 0.036, 0.008}};

Eigen::Isometry3d somewhere() {
  return Eigen::Translation3d{0.3, -0.2, 1.6} *
         Eigen::AngleAxisd{1.2, Vector3d{1, -2, 2}.normalized()};
}

TEST(SphereBody, IsSeenWhereItIsWithoutAnError) {
  std::mt19937_64 random{1};
  const SeenBody seen = seen_body(kSpheres, somewhere(), 0, random);
  EXPECT_LT((seen.tracker_T_body.matrix() - somewhere().matrix()).norm(), 1e-14);
  EXPECT_LT(seen.fit_error_m, 1e-15);
}

/// J. B. West, J. M. Fitzpatrick, IEEE Transactions on Medical Imaging 17(5), 1998: four spheres
/// fit to sqrt(1 - 2/4) of their error; their middle is off by a half of it.
TEST(SphereBody, FitsAndMissesAsManySpheresLetExpect) {
  constexpr double kError = 0.00012;
  constexpr int kSamples = 20000;
  Vector3d middle = Vector3d::Zero();
  for (const Vector3d& sphere : kSpheres) middle += sphere / 4;
  std::mt19937_64 random{7};
  SCOPED_TRACE("seed 7");
  double fit = 0, off = 0;
  for (int i = 0; i < kSamples; ++i) {
    const SeenBody seen = seen_body(kSpheres, somewhere(), kError, random);
    fit += seen.fit_error_m * seen.fit_error_m / kSamples;
    off += (seen.tracker_T_body * middle - somewhere() * middle).squaredNorm() / kSamples;
  }
  EXPECT_NEAR(std::sqrt(fit), kError * std::sqrt(0.5), 0.02 * kError);
  EXPECT_NEAR(std::sqrt(off), kError / 2, 0.01 * kError);
}

TEST(SphereBody, AScatteredPointIsOffByTheSameInAllDirections) {
  std::mt19937_64 random{3};
  SCOPED_TRACE("seed 3");
  Eigen::Matrix3d covariance = Eigen::Matrix3d::Zero();
  constexpr int kSamples = 100000;
  for (int i = 0; i < kSamples; ++i) {
    const Vector3d off = scattered({1, 2, 3}, 0.3, random) - Vector3d{1, 2, 3};
    covariance += off * off.transpose() / kSamples;
  }
  EXPECT_LT((covariance - 0.03 * Eigen::Matrix3d::Identity()).cwiseAbs().maxCoeff(), 0.0006);
}

}  // namespace
}  // namespace armature::sim::optical_tracker
