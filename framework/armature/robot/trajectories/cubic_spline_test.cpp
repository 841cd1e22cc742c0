// SPDX-License-Identifier: Apache-2.0
// Cubic splines with given velocity and acceleration at both ends.
#include "armature/robot/trajectories/cubic_spline.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

namespace armature {
namespace {

JointVector joints(std::initializer_list<double> values) {
  JointVector q(static_cast<Eigen::Index>(values.size()));
  std::copy(values.begin(), values.end(), q.begin());
  return q;
}
JointState rest(const JointVector& q) {
  return {q, JointVector::Zero(q.size()), JointVector::Zero(q.size())};
}

class CubicSplines : public testing::Test {
 protected:
  JointVector random_vector() { return joints({normal_(random_), normal_(random_)}); }
  /// `n` random points, moving at both ends.
  KnottedPieces random_spline(std::size_t n) {
    knots_ = {0.5};
    points_ = {random_vector()};
    for (std::size_t i = 1; i < n; ++i) {
      knots_.push_back(knots_.back() + 0.2 + std::abs(normal_(random_)));
      points_.push_back(random_vector());
    }
    first_ = {points_.front(), random_vector(), random_vector()};
    last_ = {points_.back(), random_vector(), random_vector()};
    return cubic_spline(knots_, points_, first_, last_);
  }

  std::mt19937_64 random_{3};
  std::normal_distribution<double> normal_;
  std::vector<double> knots_;
  std::vector<JointVector> points_;
  JointState first_, last_;
};

TEST_F(CubicSplines, PassEveryPointAtItsKnotAndHaveTheStatesOfTheEnds) {
  for (const std::size_t n : {2u, 3u, 4u, 9u}) {
    const KnottedPieces spline = random_spline(n);
    ASSERT_EQ(spline.knots.size(), n + 2);
    const auto passes = [&](double time, const JointVector& q) {
      for (std::size_t i = 0; i < spline.knots.size(); ++i) {
        if (spline.knots[i] != time) continue;
        const std::size_t piece = std::min(i, spline.knots.size() - 2);
        for (Eigen::Index j = 0; j < 2; ++j) {
          const double there = spline.pieces[2 * piece + static_cast<std::size_t>(j)].position(
              time - spline.knots[piece]);
          EXPECT_NEAR(there, q[j], 1e-13);
        }
        return true;
      }
      return false;
    };
    for (std::size_t i = 0; i < n; ++i) EXPECT_TRUE(passes(knots_[i], points_[i])) << i;
    const double h = spline.knots.back() - spline.knots[spline.knots.size() - 2];
    for (std::size_t j = 0; j < 2; ++j) {
      const Quintic &begin = spline.pieces[j], &end = spline.pieces[spline.pieces.size() - 2 + j];
      const auto joint = static_cast<Eigen::Index>(j);
      EXPECT_NEAR(begin.velocity(0), first_.v[joint], 1e-13);
      EXPECT_NEAR(begin.acceleration(0), first_.a[joint], 1e-13);
      EXPECT_NEAR(end.velocity(h), last_.v[joint], 1e-12);
      EXPECT_NEAR(end.acceleration(h), last_.a[joint], 1e-12);
    }
  }
}

TEST_F(CubicSplines, AreContinuousInTheAccelerationAndNotFurther) {
  double jerk_jump = 0;
  for (const std::size_t n : {2u, 3u, 9u}) {
    const KnottedPieces spline = random_spline(n);
    for (std::size_t i = 1; i + 1 < spline.knots.size(); ++i) {
      const double h = spline.knots[i] - spline.knots[i - 1];
      for (std::size_t j = 0; j < 2; ++j) {
        const Quintic &before = spline.pieces[2 * (i - 1) + j], &behind = spline.pieces[2 * i + j];
        EXPECT_NEAR(before.position(h), behind.position(0), 1e-13);
        EXPECT_NEAR(before.velocity(h), behind.velocity(0), 1e-11);
        EXPECT_NEAR(before.acceleration(h), behind.acceleration(0), 1e-11);
        jerk_jump = std::max(jerk_jump, std::abs(before.jerk(h) - behind.jerk(0)));
      }
    }
  }
  EXPECT_GT(jerk_jump, 1);
}

TEST_F(CubicSplines, OfACubicAreThatCubic) {
  const auto q = [](double t) { return 1 - 2 * t + 0.5 * t * t - 0.25 * t * t * t; };
  const auto v = [](double t) { return -2 + t - 0.75 * t * t; };
  const auto a = [](double t) { return 1 - 1.5 * t; };
  const std::vector<double> knots{0, 0.4, 1, 1.3, 2};
  std::vector<JointVector> points;
  for (const double t : knots) points.push_back(joints({q(t)}));
  const KnottedPieces spline =
      cubic_spline(knots, points, {points.front(), joints({v(0)}), joints({a(0)})},
                   {points.back(), joints({v(2)}), joints({a(2)})});
  for (std::size_t i = 0; i + 1 < spline.knots.size(); ++i) {
    const double t = spline.knots[i] + 0.05;
    EXPECT_NEAR(spline.pieces[i].position(0.05), q(t), 1e-14);
    EXPECT_NEAR(spline.pieces[i].acceleration(0.05), a(t), 1e-12);
  }
}

TEST_F(CubicSplines, RefuseKnotsThatDoNotAscend) {
  const JointVector q = joints({0});
  const std::vector<JointVector> points{q, q};
  EXPECT_THROW(cubic_spline(std::vector<double>{0}, std::span{points}.first(1), rest(q), rest(q)),
               std::invalid_argument);
  EXPECT_THROW(cubic_spline(std::vector<double>{1, 1}, points, rest(q), rest(q)),
               std::invalid_argument);
}

}  // namespace
}  // namespace armature
