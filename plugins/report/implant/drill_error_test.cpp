// SPDX-License-Identifier: Apache-2.0
// What brings about a drill's error: 1. nothing without an error, 2. each estimate by itself as
// geometry has it, 3. all of them add up to the whole.
#include "drill_error.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <random>

namespace armature::report::implant {
namespace {

using Eigen::Isometry3d;
using Eigen::Vector3d;

Isometry3d pose(double x, double y, double z, double angle, const Vector3d& axis) {
  return Eigen::Translation3d{x, y, z} * Eigen::AngleAxisd{angle, axis.normalized()};
}

GuidedChain truth() {
  GuidedChain chain;
  chain.base_T_tracker = pose(-1.7, 0.5, 1.2, 1.9, {0.1, 1, -0.2});
  chain.flange_T_body = pose(0.06, -0.03, 0.08, 0.4, {0.3, 0.2, 1});
  chain.tip = {0.01, 0.02, 0.09};
  chain.flange_R_tool = Eigen::AngleAxisd{0.5, Vector3d::UnitY()};
  chain.tracker_T_patient = pose(0.2, -0.1, 1.6, 2, {1, 1, 0});
  chain.patient_T_image = pose(0.03, 0.02, -0.04, 0.3, {0, 0, 1});
  return chain;
}

const Isometry3d kSite = pose(0.02, -0.01, 0.012, 0.2, {1, 0, 0});

TEST(ErrorBudget, IsNothingWithoutAnError) {
  EXPECT_LT(tip_error(truth(), truth(), kSite).norm(), 1e-15);
  EXPECT_LT(error_budget(truth(), truth(), kSite).sum().norm(), 1e-15);
}

TEST(ErrorBudget, NamesTheEstimateThatIsOff) {
  const Vector3d off{0.001, -0.002, 0.0005};
  GuidedChain estimate = truth();
  estimate.tip += off;
  ErrorBudget budget = error_budget(estimate, truth(), kSite);
  EXPECT_NEAR(budget.tool.norm(), off.norm(), 1e-12);
  EXPECT_LT((budget.tool - budget.sum()).norm(), 1e-15);

  estimate = truth();
  estimate.tracker_T_patient.pretranslate(off);
  budget = error_budget(estimate, truth(), kSite);
  EXPECT_LT((budget.tracker - truth().base_T_tracker.linear() * off).norm(), 1e-12);

  estimate = truth();
  estimate.patient_T_image.pretranslate(off);
  EXPECT_NEAR(error_budget(estimate, truth(), kSite).registration.norm(), off.norm(), 1e-12);

  estimate = truth();
  estimate.base_T_tracker.pretranslate(off);
  budget = error_budget(estimate, truth(), kSite);
  EXPECT_LT((budget.hand_eye - off).norm(), 1e-12);
  EXPECT_LT((tip_error(estimate, truth(), kSite) - off).norm(), 1e-12);
}

TEST(ErrorBudget, AddsUpToTheWholeToFirstOrder) {
  std::mt19937_64 random{17};
  SCOPED_TRACE("seed 17");
  std::normal_distribution<double> normal;
  const auto vector = [&] { return Vector3d{normal(random), normal(random), normal(random)}; };
  const auto disturb = [&](auto& transform) {
    const Vector3d turn = 1e-3 * vector();
    transform.pretranslate(1e-4 * vector());
    transform.rotate(Eigen::AngleAxisd{turn.norm(), turn.normalized()});
  };
  double worst = 0;
  for (int i = 0; i < 1000; ++i) {
    GuidedChain estimate = truth();
    disturb(estimate.base_T_tracker);
    disturb(estimate.flange_T_body);
    disturb(estimate.tracker_T_patient);
    disturb(estimate.patient_T_image);
    estimate.tip += 1e-4 * vector();
    const Vector3d whole = tip_error(estimate, truth(), kSite);
    const Vector3d sum = error_budget(estimate, truth(), kSite).sum();
    worst = std::max(worst, (whole - sum).norm());
  }
  EXPECT_LT(worst, 2e-5) << "[m], of errors of millimetres";
  EXPECT_GT(worst, 1e-8) << "to first order only";
}

}  // namespace
}  // namespace armature::report::implant
