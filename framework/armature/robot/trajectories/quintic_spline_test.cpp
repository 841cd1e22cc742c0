// SPDX-License-Identifier: Apache-2.0
#include "armature/robot/trajectories/quintic_spline.hpp"

#include <gtest/gtest.h>

#include "armature/robot/model/test_robots.hpp"

namespace armature {
namespace {

using testing::joint_vector;

/// The fourth derivative.
double snap(const Quintic& quintic, double t) { return 24 * quintic.c[4] + 120 * quintic.c[5] * t; }

struct SplineInput {
  std::vector<double> knots;
  std::vector<JointVector> points;
  JointState first, last;

  std::vector<Quintic> pieces() const { return quintic_spline(knots, points, first, last); }
};

/// Knots of uneven distance through random points of two joints, moving at both ends.
SplineInput random_input(int points, std::mt19937& random) {
  std::uniform_real_distribution<double> any{-1, 1}, step{0.05, 0.5};
  const auto vector = [&] { return joint_vector({any(random), any(random)}); };
  SplineInput input;
  for (double t = 0; static_cast<int>(input.knots.size()) < points; t += step(random)) {
    input.knots.push_back(t);
    input.points.push_back(vector());
  }
  input.first = {input.points.front(), vector(), vector()};
  input.last = {input.points.back(), vector(), vector()};
  return input;
}

TEST(QuinticSpline, PassesThroughEveryPointWithContinuousDerivativesUpToSnap) {
  std::mt19937 random{31};
  for (int points = 2; points < 40; ++points) {
    SCOPED_TRACE(::testing::Message() << "seed 31, points " << points);
    const SplineInput input = random_input(points, random);
    const auto pieces = input.pieces();
    ASSERT_EQ(pieces.size(), 2 * (input.knots.size() - 1));
    for (std::size_t k = 0; k + 1 < input.knots.size(); ++k)
      for (std::size_t j = 0; j < 2; ++j) {
        const Quintic& piece = pieces[2 * k + j];
        const double h = input.knots[k + 1] - input.knots[k];
        const auto joint = static_cast<Eigen::Index>(j);
        ASSERT_NEAR(piece.position(0), input.points[k][joint], 1e-12);
        ASSERT_NEAR(piece.position(h), input.points[k + 1][joint], 1e-11);
        if (k + 2 == input.knots.size()) continue;
        const Quintic& next = pieces[2 * k + 2 + j];
        const double size = 1 + std::abs(next.jerk(0)) + std::abs(snap(next, 0));
        ASSERT_NEAR(piece.velocity(h), next.velocity(0), 1e-11 * size);
        ASSERT_NEAR(piece.acceleration(h), next.acceleration(0), 1e-11 * size);
        ASSERT_NEAR(piece.jerk(h), next.jerk(0), 1e-9 * size);
        ASSERT_NEAR(snap(piece, h), snap(next, 0), 1e-8 * size);
      }
  }
}

TEST(QuinticSpline, LeavesAndArrivesWithTheGivenVelocitiesAndAccelerations) {
  std::mt19937 random{32};
  const SplineInput input = random_input(9, random);
  const auto pieces = input.pieces();
  const double h = input.knots[8] - input.knots[7];
  for (std::size_t j = 0; j < 2; ++j) {
    const auto joint = static_cast<Eigen::Index>(j);
    EXPECT_NEAR(pieces[j].velocity(0), input.first.v[joint], 1e-12);
    EXPECT_NEAR(pieces[j].acceleration(0), input.first.a[joint], 1e-12);
    EXPECT_NEAR(pieces[14 + j].velocity(h), input.last.v[joint], 1e-9);
    EXPECT_NEAR(pieces[14 + j].acceleration(h), input.last.a[joint], 1e-8);
  }
}

TEST(QuinticSpline, ReproducesAQuinticPolynomialExactly) {
  const Quintic wanted{{0.3, -1, 2, 0.7, -1.5, 0.4}};
  const std::vector<double> knots{0, 0.1, 0.4, 0.45, 1.2, 2};
  std::vector<JointVector> points;
  for (const double t : knots) points.push_back(joint_vector({wanted.position(t)}));
  const auto end = [&](double t) {
    return JointState{joint_vector({wanted.position(t)}), joint_vector({wanted.velocity(t)}),
                      joint_vector({wanted.acceleration(t)})};
  };
  const auto pieces = quintic_spline(knots, points, end(0), end(2));
  for (std::size_t k = 0; k < pieces.size(); ++k) {
    const Quintic same = wanted.shifted(knots[k]);
    for (std::size_t i = 0; i < 6; ++i) EXPECT_NEAR(pieces[k].c[i], same.c[i], 1e-7) << k;
  }
}

/// Largest distance from sin on [0, 3] with `pieces` pieces.
double sine_error(int pieces) {
  std::vector<double> knots;
  std::vector<JointVector> points;
  for (int i = 0; i <= pieces; ++i) {
    knots.push_back(3.0 * i / pieces);
    points.push_back(joint_vector({std::sin(knots.back())}));
  }
  const auto end = [](double t) {
    return JointState{joint_vector({std::sin(t)}), joint_vector({std::cos(t)}),
                      joint_vector({-std::sin(t)})};
  };
  const auto spline = quintic_spline(knots, points, end(0), end(3));
  double worst = 0;
  for (int i = 0; i < 1000; ++i) {
    const double t = 0.003 * i;
    const auto piece = std::min(static_cast<std::size_t>(t / 3 * pieces), spline.size() - 1);
    worst = std::max(worst, std::abs(spline[piece].position(t - knots[piece]) - std::sin(t)));
  }
  return worst;
}

TEST(QuinticSpline, ErrorFallsWithTheSixthPowerOfTheDistanceOfKnots) {
  EXPECT_GT(sine_error(6) / sine_error(12), 50);  // 64 in the limit
  EXPECT_LT(sine_error(12) / sine_error(24), 80);
  EXPECT_LT(sine_error(24), 1e-8);
}

TEST(QuinticSpline, StaysAccurateWithThousandsOfKnots) { EXPECT_LT(sine_error(5000), 1e-12); }

TEST(QuinticSpline, RefusesKnotsThatDoNotAscend) {
  SplineInput input;
  input.points = {joint_vector({0}), joint_vector({1}), joint_vector({2})};
  input.first = input.last = {joint_vector({0}), joint_vector({0}), joint_vector({0})};
  input.knots = {0, 1, 1};
  EXPECT_THROW(input.pieces(), std::invalid_argument);
  input.knots = {0, 1};
  EXPECT_THROW(input.pieces(), std::invalid_argument);
}

}  // namespace
}  // namespace armature
