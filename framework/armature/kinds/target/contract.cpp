// SPDX-License-Identifier: Apache-2.0
#include "armature/kinds/target/contract.hpp"

namespace armature {
namespace {

struct Foreign {
  static constexpr auto kLayout = layout_id("target/another", 1);
  double number = 7;
};

}  // namespace

TargetMeasurement TargetLaws::look(double t_s) {
  const auto noise = [&] {
    return Eigen::Vector3d{normal_(random_), normal_(random_), normal_(random_)};
  };
  return {
      .stamp = Time{} + seconds(t_s),
      .position = kMouth + 0.001 * noise(),
      .normal = (kNormal + 0.02 * noise()).normalized(),
      .position_covariance = 1e-6 * Eigen::Matrix3d::Identity(),
      .normal_covariance = 4e-4 * (Eigen::Matrix3d::Identity() - kNormal * kNormal.transpose())};
}

PluginState TargetLaws::started() {
  PluginState state;
  for (int i = 0; i < 10; ++i) EXPECT_TRUE(filter().update(look(0.1 * i), state));
  return state;
}

void TargetLaws::expect_same_prediction(const PluginState& a, const PluginState& b) {
  const Time when = Time{} + seconds(1.2);
  const auto first = filter().predict(when, a), second = filter().predict(when, b);
  ASSERT_TRUE(first && second);
  EXPECT_EQ(first->position, second->position);
  EXPECT_EQ(first->velocity, second->velocity);
  EXPECT_EQ(first->normal, second->normal);
  EXPECT_EQ(first->normal_rate, second->normal_rate);
  EXPECT_EQ(first->measurements, second->measurements);
}

GTEST_ALLOW_UNINSTANTIATED_PARAMETERIZED_TEST(TargetLaws);

TEST_P(TargetLaws, StartsWithTheFirstMeasurement) {
  PluginState state;
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
  PluginState state;
  for (int i = 0; i < 100; ++i) {
    const auto estimate = filter().update(look(0.1 * i), state);
    ASSERT_TRUE(estimate) << estimate.error().text;
    EXPECT_NEAR(estimate->normal.norm(), 1, 1e-9);
    EXPECT_NEAR(estimate->normal.dot(estimate->normal_rate), 0, 1e-9);
  }
}

TEST_P(TargetLaws, PredictsFromTheEstimateWithoutAJump) {
  PluginState state = started();
  const TargetMeasurement measurement = look(1);
  const auto now = filter().update(measurement, state);
  ASSERT_TRUE(now);
  const auto same = filter().predict(measurement.stamp, state);
  ASSERT_TRUE(same) << same.error().text;
  EXPECT_EQ(same->stamp, measurement.stamp);
  EXPECT_LT((same->position - now->position).norm(), 1e-12);
  EXPECT_LT((same->normal - now->normal).norm(), 1e-12);
}

TEST_P(TargetLaws, RemembersNothingBesidesTheState) {
  PluginState state = started(), copy = state;
  const TargetMeasurement next = look(1), elsewhere = look(7);
  const auto first = filter().update(next, state);
  PluginState other;
  filter().update(elsewhere, other);
  const auto second = filter().update(next, copy);
  ASSERT_TRUE(first && second);
  EXPECT_EQ(first->position, second->position);
  EXPECT_EQ(first->normal, second->normal);
  expect_same_prediction(state, copy);
}

TEST_P(TargetLaws, RefusesBadMeasurementsAndKeepsItsState) {
  PluginState state = started();
  const PluginState before = state;
  TargetMeasurement not_finite = look(1), no_normal = look(1), no_sigma = look(1);
  not_finite.position.x() = std::nan("");
  no_normal.normal.setZero();
  no_sigma.position_covariance(1, 1) = std::nan("");
  TargetMeasurement negative = look(1), endless = look(1);
  negative.position_covariance(0, 0) = -1;
  endless.normal_covariance *= 1e300;
  for (const auto& bad : {not_finite, no_normal, no_sigma, negative, endless, look(0.5)}) {
    const auto refused = filter().update(bad, state);
    ASSERT_FALSE(refused);
    EXPECT_FALSE(refused.error().text.empty());
    expect_same_prediction(state, before);
  }
}

TEST_P(TargetLaws, TakesAStateOfAnotherPluginForNone) {
  PluginState state;
  state.set(Foreign{});
  EXPECT_FALSE(filter().predict(Time{}, state));
  const auto estimate = filter().update(look(3), state);
  ASSERT_TRUE(estimate) << estimate.error().text;
  EXPECT_EQ(estimate->measurements, 1);
}

}  // namespace armature
