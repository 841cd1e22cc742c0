// SPDX-License-Identifier: Apache-2.0
#include "armature/kinds/trajectory/joint_curve.hpp"

#include <gtest/gtest.h>

namespace armature {
namespace {

JointVector wave(double s) { return Eigen::Vector2d{std::sin(2 * s), 0.3 * s * s}; }
JointVector wave_slope(double s) { return Eigen::Vector2d{2 * std::cos(2 * s), 0.6 * s}; }
JointVector wave_bend(double s) { return Eigen::Vector2d{-4 * std::sin(2 * s), 0.6}; }

JointCurve sampled(int n) {
  std::vector<double> s;
  std::vector<JointVector> q;
  for (int i = 0; i <= n; ++i) {
    s.push_back(static_cast<double>(i) / n);
    q.push_back(wave(s.back()));
  }
  return {s, q};
}

TEST(JointCurve, PassesThroughItsWaypoints) {
  const JointCurve curve = sampled(12);
  for (std::size_t i = 0; i < curve.s().size(); ++i) {
    EXPECT_LE((curve.at(curve.s()[i]).q - curve.waypoints()[i]).norm(), 1e-14);
  }
}

TEST(JointCurve, FollowsASmoothCurveWithItsDerivatives) {
  const JointCurve curve = sampled(20);
  for (double s = 0; s <= 1; s += 0.01) {
    const JointState state = curve.at(s);
    EXPECT_LE((state.q - wave(s)).norm(), 1e-8);
    EXPECT_LE((state.v - wave_slope(s)).norm(), 3e-6);
    EXPECT_LE((state.a - wave_bend(s)).norm(), 2e-4);
  }
}

TEST(JointCurve, TwoWaypointsAreAStraightLine) {
  const JointCurve line{{0, 1}, {Eigen::Vector2d{1, 2}, Eigen::Vector2d{3, -2}}};
  for (double s = 0; s <= 1; s += 0.125) {
    const JointState state = line.at(s);
    EXPECT_LE((state.q - Eigen::Vector2d{1 + 2 * s, 2 - 4 * s}).norm(), 1e-14);
    EXPECT_LE((state.v - Eigen::Vector2d{2, -4}).norm(), 1e-13);
    EXPECT_LE(state.a.norm(), 1e-12);
  }
}

TEST(JointCurve, ThreeWaypointsOnAParabolaAreThatParabola) {
  const JointVector one = Eigen::Matrix<double, 1, 1>::Ones();
  const JointCurve curve{{0, 0.25, 1}, {0 * one, 0.0625 * one, one}};
  EXPECT_NEAR(curve.at(0.6).q[0], 0.36, 1e-12);
  EXPECT_NEAR(curve.at(0.6).v[0], 1.2, 1e-12);
  EXPECT_NEAR(curve.at(0).a[0], 2, 1e-12);
}

}  // namespace
}  // namespace armature
