// SPDX-License-Identifier: Apache-2.0
#include "cubic_spline.hpp"

#include <gtest/gtest.h>

#include "armature/kinds/trajectory/contract.hpp"
#include "armature/kinds/trajectory/random_requests.hpp"

namespace armature::trajectory::cubic_spline {
namespace {

INSTANTIATE_TEST_SUITE_P(
    CubicSpline, TrajectoryLaws,
    testing::Values(TrajectorySubject{"cubic_spline",
                                      std::make_shared<CubicSplineTrajectory>(Parameters{})},
                    TrajectorySubject{
                        "cubic_spline_optimum",
                        std::make_shared<CubicSplineTrajectory>(Parameters{.optimum_tries = 300})}),
    testing::PrintToStringParamName());

class CubicSplinePlans : public testing::Test, public RandomRequests {
 protected:
  const TrajectoryPlanner& planner() const { return plain_; }

 private:
  const CubicSplineTrajectory plain_{Parameters{}};
};

TEST_F(CubicSplinePlans, TheOptimumIsNeverSlowerAndOftenMuchFaster) {
  const CubicSplineTrajectory optimum{{.optimum_tries = 5000}};
  double shorter = 0;
  constexpr int kPlans = 50;
  for (int i = 0; i < kPlans; ++i) {
    TrajectoryRequest wanted = request(0);
    wanted.segments = {curve_from(wanted.from.q, 2 + i % 10, 1)};
    const auto plain = planner().plan(wanted), best = optimum.plan(wanted);
    ASSERT_TRUE(plain && best);
    EXPECT_LE(best->duration_s(), plain->duration_s() * (1 + 1e-9));
    shorter += 1 - best->duration_s() / plain->duration_s();
  }
  EXPECT_GT(shorter / kPlans, 0.1);
}

TEST_F(CubicSplinePlans, AFewTriesAreNoWorseThanNone) {
  TrajectoryRequest wanted = request(0);
  wanted.segments = {curve_from(wanted.from.q, 6, 1)};
  double before = planner().plan(wanted)->duration_s();
  for (const int tries : {1, 10, 100, 1000}) {
    const double now = CubicSplineTrajectory{{.optimum_tries = tries}}.plan(wanted)->duration_s();
    EXPECT_LE(now, before * (1 + 1e-9)) << tries;
    before = now;
  }
}

}  // namespace
}  // namespace armature::trajectory::cubic_spline
