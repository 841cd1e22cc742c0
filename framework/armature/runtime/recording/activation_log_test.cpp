// SPDX-License-Identifier: Apache-2.0
#include "armature/runtime/recording/activation_log.hpp"

#include <gtest/gtest.h>

#include <array>
#include <thread>
#include <vector>

#include "armature/messages/std_msgs.hpp"

namespace armature {
namespace {

using Kind = ActivationLog::Entry::Kind;

class ActivationLogTest : public ::testing::Test {
 protected:
  /// A call that reads one sample and publishes it again.
  void call(ActivationLog& log, Time now) {
    log.begin(ComponentCall::step, now);
    const std::array read{pool_.loan()};
    log.read(0, read);
    log.published(read.front());
    log.end("");
  }
  static std::vector<Kind> take_all(ActivationLog& log) {
    std::vector<Kind> kinds;
    while (const auto entry = log.take()) kinds.push_back(entry->kind);
    return kinds;
  }

  static constexpr std::array kCall{Kind::begin, Kind::read, Kind::published, Kind::end};
  SamplePool pool_{message_type<msg::Bool>(), 2};
  SimulatedClock clock_;
};

TEST_F(ActivationLogTest, ShowsACallOnceItHasEnded) {
  ActivationLog log{16, clock_, false};
  clock_.set(Time{7});
  log.begin(ComponentCall::begin_stop, Time{5});
  EXPECT_TRUE(log.has_subscribers(true));
  log.published(pool_.loan());
  EXPECT_FALSE(log.take());
  log.end("");
  const auto begin = log.take();
  ASSERT_TRUE(begin);
  EXPECT_EQ(begin->call, ComponentCall::begin_stop);
  EXPECT_EQ(begin->number, 5);
  EXPECT_TRUE(log.take()->answer);
  EXPECT_EQ(log.take()->number, 7) << "when it was published";
  EXPECT_EQ(log.take()->kind, Kind::end);
  EXPECT_FALSE(log.take());
}

TEST_F(ActivationLogTest, LosesWholeCallsAndCountsThem) {
  ActivationLog log{8, clock_, false};
  for (int i = 0; i < 5; ++i) call(log, Time{i});
  EXPECT_EQ(log.lost(), 3U);
  EXPECT_EQ(log.lost_samples(), 3U);
  EXPECT_EQ(take_all(log).size(), 2 * kCall.size());
  EXPECT_EQ(pool_.grown(), 1U) << "a sample of a lost call was kept";
  call(log, Time{5});
  log.take();
  const auto lost = log.take();
  EXPECT_EQ(lost->kind, Kind::lost);
  EXPECT_EQ(lost->number, 3);
}

TEST_F(ActivationLogTest, LetsSamplesGoWhenTheyAreTaken) {
  ActivationLog log{16, clock_, false};
  for (int i = 0; i < 100; ++i) {
    call(log, Time{i});
    EXPECT_EQ(take_all(log), std::vector(kCall.begin(), kCall.end()));
  }
  EXPECT_EQ(pool_.grown(), 0U);
}

TEST_F(ActivationLogTest, KeepsWhatCameOutOfACallThatFailed) {
  ActivationLog log{16, clock_, false};
  log.begin(ComponentCall::step, Time{1});
  EXPECT_TRUE(log.is_called());
  log.end("step failed: no light");
  EXPECT_FALSE(log.is_called());
  EXPECT_EQ(take_all(log), (std::vector{Kind::begin, Kind::failed, Kind::end}));
  EXPECT_EQ(log.failure(), "step failed: no light");
}

TEST_F(ActivationLogTest, OnTheSimulatedClockTheComponentWaitsForRoom) {
  ActivationLog log{8, clock_, true};
  std::thread component{[&] {
    for (int i = 0; i < 100; ++i) call(log, Time{i});
  }};
  std::size_t taken = 0;
  while (taken < 100 * kCall.size()) taken += take_all(log).size();
  component.join();
  EXPECT_EQ(log.lost(), 0U);
}

TEST_F(ActivationLogTest, ACallThatIsLongerThanTheRingIsLost) {
  ActivationLog log{2, clock_, true};
  call(log, Time{1});
  EXPECT_EQ(log.lost(), 1U);
  EXPECT_FALSE(log.take());
}

TEST_F(ActivationLogTest, WhatAnotherThreadPublishesBelongsToNoCall) {
  ActivationLog log{16, clock_, false};
  log.begin(ComponentCall::step, Time{1});
  std::thread{[&] { log.published(pool_.loan()); }}.join();
  log.end("");
  log.published(pool_.loan());
  EXPECT_EQ(take_all(log).size(), 2U);
  EXPECT_EQ(log.strays(), 2U);
}

}  // namespace
}  // namespace armature
