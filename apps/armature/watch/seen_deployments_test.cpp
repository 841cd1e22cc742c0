// SPDX-License-Identifier: Apache-2.0
#include "watch/seen_deployments.hpp"

#include <gtest/gtest.h>

namespace armature {
namespace {

SeenComponent told_at(double told_s, double stamp_s, std::uint64_t activations) {
  SeenComponent component{.stamp = Time{} + seconds(stamp_s), .told = Time{} + seconds(told_s)};
  component.state.activations_(activations);
  component.state.processor_().mean_(0.002);
  return component;
}

TEST(SeenComponent, CountsItsRateByTheDeploymentsClock) {
  const SeenComponent first = seen_after(std::nullopt, told_at(1000, 10, 100));
  EXPECT_EQ(first.rate_hz, 0) << "one state has no rate";
  const SeenComponent second = seen_after(first, told_at(1000.1, 10.5, 150));
  EXPECT_DOUBLE_EQ(second.rate_hz, 100);
}

TEST(SeenComponent, CountsItsProcessorTimeByTheClockOfItsMachine) {
  const SeenComponent first = seen_after(std::nullopt, told_at(1000, 10, 100));
  // Half a second of simulated time that took 0.2 s, 50 steps of 2 ms in it.
  const SeenComponent second = seen_after(first, told_at(1000.2, 10.5, 150));
  EXPECT_NEAR(second.processor, 0.5, 1e-9);
}

TEST(SeenComponent, ThatWasStartedAgainBeginsAnew) {
  const SeenComponent first = seen_after(std::nullopt, told_at(1000, 10, 100));
  EXPECT_EQ(seen_after(first, told_at(1001, 0.5, 5)).rate_hz, 0);
}

TEST(SeenDeployment, IsWholeWhenAllItsProcessesHaveTold) {
  SeenDeployment deployment;
  EXPECT_FALSE(deployment.is_whole());
  msg::DeploymentDescription description;
  description.processes_({"main", "vision"});
  deployment.processes["main"] = description;
  EXPECT_FALSE(deployment.is_whole());
  deployment.processes["vision"] = description;
  EXPECT_TRUE(deployment.is_whole());
}

}  // namespace
}  // namespace armature
