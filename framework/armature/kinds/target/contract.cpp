// SPDX-License-Identifier: Apache-2.0
#include "armature/kinds/target/contract.hpp"

namespace armature {

TargetMeasurement TargetLaws::look(double t_s) {
  const auto noise = [&] {
    return Eigen::Vector3d{normal_(random_), normal_(random_), normal_(random_)};
  };
  return {.stamp = Time{} + seconds(t_s),
          .position = kMouth + 0.001 * noise(),
          .normal = (kNormal + 0.02 * noise()).normalized(),
          .position_sigma_m = 0.001,
          .normal_sigma_rad = 0.02};
}

TargetFilter::State TargetLaws::started() {
  TargetFilter::State state;
  for (int i = 0; i < 10; ++i) EXPECT_TRUE(filter().update(look(0.1 * i), state));
  return state;
}

GTEST_ALLOW_UNINSTANTIATED_PARAMETERIZED_TEST(TargetLaws);

TEST_P(TargetLaws, StartsWithTheFirstMeasurement) {
  TargetFilter::State state;
  EXPECT_FALSE(filter().predict(Time{}, state));
  const TargetMeasurement first = look(3);
  const auto estimate = filter().update(first, state);
  ASSERT_TRUE(estimate) << estimate.error().text;
  EXPECT_EQ(estimate->stamp, first.stamp);
  EXPECT_EQ(estimate->measurements, 1);
  EXPECT_LT((estimate->position - first.position).norm(), 1e-12);
  EXPECT_LT((estimate->normal - first.normal).norm(), 1e-12);
}

TEST_P(TargetLaws, KeepsTheNormalAUnitVectorAndItsRateAcross) {
  TargetFilter::State state;
  for (int i = 0; i < 100; ++i) {
    const auto estimate = filter().update(look(0.1 * i), state);
    ASSERT_TRUE(estimate) << estimate.error().text;
    EXPECT_NEAR(estimate->normal.norm(), 1, 1e-9);
    EXPECT_NEAR(estimate->normal.dot(estimate->normal_rate), 0, 1e-9);
  }
}

TEST_P(TargetLaws, PredictsFromTheEstimateWithoutAJumpAndWithoutChangingTheState) {
  TargetFilter::State state = started();
  const TargetMeasurement measurement = look(1);
  const auto now = filter().update(measurement, state);
  ASSERT_TRUE(now);
  const TargetFilter::State before = state;
  const auto same = filter().predict(measurement.stamp, state);
  ASSERT_TRUE(same) << same.error().text;
  EXPECT_EQ(same->stamp, measurement.stamp);
  EXPECT_LT((same->position - now->position).norm(), 1e-12);
  EXPECT_LT((same->normal - now->normal).norm(), 1e-12);
  EXPECT_EQ(state.mean, before.mean);
}

TEST_P(TargetLaws, RemembersNothingBesidesTheState) {
  TargetFilter::State state = started(), copy = state;
  const TargetMeasurement next = look(1), elsewhere = look(7);
  const auto first = filter().update(next, state);
  TargetFilter::State other;
  filter().update(elsewhere, other);
  const auto second = filter().update(next, copy);
  ASSERT_TRUE(first && second);
  EXPECT_EQ(first->position, second->position);
  EXPECT_EQ(first->normal, second->normal);
  EXPECT_EQ(state.covariance, copy.covariance);
}

TEST_P(TargetLaws, RefusesBadMeasurementsAndKeepsItsState) {
  TargetFilter::State state = started();
  const TargetFilter::State before = state;
  TargetMeasurement not_finite = look(1), no_normal = look(1), no_sigma = look(1);
  not_finite.position.x() = std::nan("");
  no_normal.normal.setZero();
  no_sigma.position_sigma_m = std::nan("");
  for (const auto& bad : {not_finite, no_normal, no_sigma, look(0.5)}) {
    const auto refused = filter().update(bad, state);
    ASSERT_FALSE(refused);
    EXPECT_FALSE(refused.error().text.empty());
    EXPECT_EQ(state.mean, before.mean);
    EXPECT_EQ(state.covariance, before.covariance);
    EXPECT_EQ(state.measurements, before.measurements);
  }
}
}  // namespace armature
