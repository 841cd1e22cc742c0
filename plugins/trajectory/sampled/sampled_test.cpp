// SPDX-License-Identifier: Apache-2.0
#include "sampled.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "armature/kinds/trajectory/contract.hpp"

namespace armature::trajectory::sampled {
namespace {

INSTANTIATE_TEST_SUITE_P(Sampled, TrajectoryLaws,
                         testing::Values(TrajectorySubject{"sampled",
                                                           std::make_shared<SampledTrajectory>()}),
                         testing::PrintToStringParamName());

/// A circle of 0.3 rad in two joints, run under s = 10 x^3 - 15 x^4 + 6 x^5.
JointVector on_circle(double x) {
  const double s = x * x * x * (10 + x * (-15 + 6 * x));
  JointVector q(2);
  q << 0.3 * std::cos(6 * s), 0.3 * std::sin(6 * s);
  return q;
}

TrajectoryRequest circle(int parts) {
  const JointVector zero = JointVector::Zero(2);
  JointSegment segment{.s = {}, .q = {}, .duration_s = 4};
  for (int i = 0; i <= parts; ++i) {
    segment.s.push_back(static_cast<double>(i) / parts);
    segment.q.push_back(on_circle(segment.s.back()));
  }
  return {.goal_id = 1,
          .start = {},
          .from = {segment.q.front(), zero, zero},
          .segments = {segment},
          .max_velocity = JointVector::Constant(2, 2),
          .max_acceleration = JointVector::Constant(2, 8)};
}

TEST(SampledTrajectory, KeepsThePathsOwnTimeLawAndItsSamples) {
  const TrajectoryRequest request = circle(100);
  const auto planned = SampledTrajectory{}.plan(request);
  ASSERT_TRUE(planned) << planned.error().text;
  EXPECT_EQ(planned->duration_s(), 4);
  EXPECT_EQ(planned->piece_count(), 100);
  for (std::size_t i = 0; i < planned->knots.size(); ++i) {
    EXPECT_NEAR(planned->knots[i], 0.04 * static_cast<double>(i), 1e-15);
    const JointVector q = planned->at(planned->start + seconds(planned->knots[i])).q;
    EXPECT_LT((q - request.segments[0].q[i]).norm(), 1e-10) << "sample " << i;
  }
}

TEST(SampledTrajectory, BetweenDenseSamplesItIsTheCurveThatTheyWereTakenFrom) {
  double before = 0;
  for (const int parts : {50, 100}) {
    const auto planned = SampledTrajectory{}.plan(circle(parts));
    ASSERT_TRUE(planned);
    double off = 0;
    for (int i = 0; i <= 1000; ++i) {
      const double x = i / 1000.0;
      const JointVector q = planned->at(planned->start + seconds(4 * x)).q;
      off = std::max(off, (q - on_circle(x)).norm());
    }
    if (parts == 100) {
      EXPECT_LT(off, 1e-6);
      EXPECT_LT(off, before / 8) << "twice the samples are far more than twice as near";
    }
    before = off;
  }
}

}  // namespace
}  // namespace armature::trajectory::sampled
