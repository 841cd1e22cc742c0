// SPDX-License-Identifier: Apache-2.0
// SR-1, cubic splines through joint knots: the reference case, at rest and without acceleration at
// both ends.
#include <gtest/gtest.h>

#include <algorithm>
#include <vector>

#include "armature/robot/trajectories/cubic_spline.hpp"
#include "reference_file.hpp"

namespace armature::paper {
namespace {

KnottedPieces spline() {
  const Figures figures = sr1()["lcl_spline"];
  const Eigen::VectorXd values = figures["knots"].numbers(), h = figures["intervals"].numbers();
  std::vector<double> knots{0};
  for (const double interval : h) knots.push_back(knots.back() + interval);
  std::vector<JointVector> points;
  for (const double value : values) points.push_back(JointVector::Constant(1, value));
  const JointVector zero = JointVector::Zero(1);
  return cubic_spline(knots, points, {points.front(), zero, zero}, {points.back(), zero, zero});
}

TEST(Sr1CubicSpline, HasTheKnotsAndTheAccelerationsOfTheReference) {
  const Figures figures = sr1()["lcl_spline"];
  const Eigen::VectorXd times = figures["knot_times"].numbers();
  const Eigen::VectorXd values = figures["knot_values"].numbers();
  const Eigen::VectorXd accelerations = figures["knot_accelerations"].numbers();
  const KnottedPieces cubics = spline();
  ASSERT_EQ(static_cast<Eigen::Index>(cubics.knots.size()), times.size());
  for (std::size_t i = 0; i + 1 < cubics.knots.size(); ++i) {
    const auto k = static_cast<Eigen::Index>(i);
    EXPECT_NEAR(cubics.knots[i], times[k], 1e-14);
    EXPECT_NEAR(cubics.pieces[i].position(0), values[k], 1e-12);
    EXPECT_NEAR(cubics.pieces[i].acceleration(0), accelerations[k], 1e-12);
  }
}

TEST(Sr1CubicSpline, RunsThroughTheSamplesOfTheReference) {
  const Figures samples = sr1()["lcl_spline"]["samples"];
  const KnottedPieces cubics = spline();
  ASSERT_EQ(samples.size(), 11u);
  for (std::size_t i = 0; i < samples.size(); ++i) {
    const Eigen::VectorXd row = samples[i].numbers();  // t, q, v, a
    const auto behind = std::upper_bound(cubics.knots.begin() + 1, cubics.knots.end() - 1, row[0]);
    const auto piece = static_cast<std::size_t>(behind - cubics.knots.begin() - 1);
    const double t = row[0] - cubics.knots[piece];
    EXPECT_NEAR(cubics.pieces[piece].position(t), row[1], 1e-12) << i;
    EXPECT_NEAR(cubics.pieces[piece].velocity(t), row[2], 1e-12) << i;
    EXPECT_NEAR(cubics.pieces[piece].acceleration(t), row[3], 1e-11) << i;
  }
}

}  // namespace
}  // namespace armature::paper
