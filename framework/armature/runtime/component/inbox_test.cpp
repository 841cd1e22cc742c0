// SPDX-License-Identifier: Apache-2.0
#include "armature/runtime/component/inbox.hpp"

#include <gtest/gtest.h>

#include "armature/runtime/component/ports.hpp"

namespace armature {
namespace {

struct Stamped {
  Time stamp;
  int value;
};

MessageType stamped_type() {
  MessageType type;
  type.ros_name = "test_msgs/Stamped";
  type.create = [] { return static_cast<void*>(new Stamped{}); };
  type.destroy = [](void* message) { delete static_cast<Stamped*>(message); };
  type.stamp = [](const void* message) { return static_cast<const Stamped*>(message)->stamp; };
  return type;
}

class InboxTest : public testing::Test {
 protected:
  MessageType type = stamped_type();
  SamplePool pool{type, 4};
  int triggers = 0;
  Inbox inbox{[this] { ++triggers; }};

  InputPort& add(PortSpec spec) { return inbox.add(std::move(spec), type); }
  void send(InputPort& port, int value, Time stamp = {}) {
    SampleRef sample = pool.loan();
    *static_cast<Stamped*>(sample.mutable_message()) = {stamp, value};
    port.deliver(sample);
  }
  std::vector<int> shown(const InputPort& port) const {
    std::vector<int> values;
    const Input<Stamped> input{port};
    for (std::size_t i = 0; i < input.size(); ++i) values.push_back(input[i].value);
    return values;
  }
};

TEST_F(InboxTest, LatestShowsOnlyTheNewestAndKeepsItUntilANewerOneComes) {
  InputPort& port = add({.name = "in"});
  send(port, 1);
  send(port, 2);
  inbox.show({});
  EXPECT_EQ(shown(port), std::vector<int>{2});
  EXPECT_TRUE(port.fresh());
  inbox.show({});
  EXPECT_EQ(shown(port), std::vector<int>{2});
  EXPECT_FALSE(port.fresh());
}

TEST_F(InboxTest, QueueShowsEverySampleOnceAndDropsTheOldestWhenFull) {
  InputPort& port = add({.name = "in", .queue = 3});
  for (int i = 1; i <= 5; ++i) send(port, i);
  inbox.show({});
  EXPECT_EQ(shown(port), (std::vector<int>{3, 4, 5}));
  EXPECT_EQ(inbox.dropped(), 2U);
  inbox.show({});
  EXPECT_TRUE(shown(port).empty());
}

TEST_F(InboxTest, SamplesThatWereLostOnTheWayCountAsDroppedAlsoWhereTheNextIsNotHeeded) {
  InputPort& port = add({.name = "in"});
  const auto send_after = [&](std::uint64_t lost) {
    SampleRef sample = pool.loan();
    sample.mutable_info().lost_before = lost;
    port.deliver(sample);
    sample.mutable_info().lost_before = 0;
  };
  send_after(0);
  EXPECT_EQ(inbox.dropped(), 0U) << "overwritten by the newest, as `latest` wants it";
  send_after(2);
  EXPECT_EQ(inbox.dropped(), 2U);
  port.heed_only([](const void*) { return false; });
  send_after(1);
  EXPECT_EQ(inbox.dropped(), 3U);
  inbox.close();
  send_after(5);
  EXPECT_EQ(inbox.dropped(), 3U);
}

TEST_F(InboxTest, WhatArrivesWhileAStepRunsIsShownToTheNextOne) {
  InputPort& port = add({.name = "in", .queue = 4});
  send(port, 1);
  inbox.show({});
  send(port, 2);
  EXPECT_EQ(shown(port), std::vector<int>{1});
  inbox.show({});
  EXPECT_EQ(shown(port), std::vector<int>{2});
}

Time at_ms(std::int64_t stamp) { return Time{stamp * 1'000'000}; }

TEST_F(InboxTest, AnswersToTheOldestMeasurementThatIsNew) {
  InputPort& image = add({.name = "image"});
  InputPort& joints = add({.name = "joints"});
  image.set_source(0, true);
  joints.set_source(1, true);
  send(image, 1, at_ms(30));
  send(joints, 1, at_ms(10));
  inbox.show({});
  EXPECT_EQ(inbox.answers_to().source, 1);
  EXPECT_EQ(inbox.answers_to().at, at_ms(10));
  send(image, 2, at_ms(40));
  inbox.show({});
  EXPECT_EQ(inbox.answers_to().source, 0);
  EXPECT_EQ(inbox.answers_to().at, at_ms(40));
  inbox.show({});
  EXPECT_EQ(inbox.answers_to().source, -1) << "nothing is new";
}

TEST_F(InboxTest, AnswersToWhatItsSamplesAnswerTo) {
  InputPort& face = add({.name = "face", .queue = 4});
  InputPort& feedback = add({.name = "measured", .feedback = true});
  const auto send_answer = [&](InputPort& port, int source, Time at) {
    SampleRef sample = pool.loan();
    sample.mutable_info().answers_to = {.source = source, .at = at};
    port.deliver(sample);
  };
  send_answer(face, 2, at_ms(20));
  send_answer(face, 3, at_ms(15));
  send_answer(feedback, 4, at_ms(5));
  inbox.show({});
  EXPECT_EQ(inbox.answers_to().source, 3);
  EXPECT_EQ(inbox.answers_to().at, at_ms(15)) << "feedback is what came of an answer";
}

TEST_F(InboxTest, OnlyTriggerInputsTrigger) {
  InputPort& quiet = add({.name = "quiet"});
  InputPort& loud = add({.name = "loud", .trigger = true});
  send(quiet, 1);
  EXPECT_EQ(triggers, 0);
  send(loud, 1);
  EXPECT_EQ(triggers, 1);
}

TEST_F(InboxTest, JoinedInputsAreShownOnlyTogetherAndWithEqualStamps) {
  InputPort& left = add({.name = "left", .trigger = true, .join = true});
  InputPort& right = add({.name = "right", .trigger = true, .join = true});
  send(left, 10, Time{100});
  inbox.show({});
  EXPECT_TRUE(shown(left).empty());
  send(left, 20, Time{200});
  send(right, 21, Time{200});
  EXPECT_EQ(triggers, 1);
  inbox.show({});
  EXPECT_EQ(shown(left), std::vector<int>{20});
  EXPECT_EQ(shown(right), std::vector<int>{21});
}

TEST_F(InboxTest, AJoinPartnerThatNeverComesBlocksNothingAfterIt) {
  InputPort& left = add({.name = "left", .join = true});
  InputPort& right = add({.name = "right", .join = true});
  for (int i = 0; i < 20; ++i) send(left, i, Time{i});
  send(right, 119, Time{19});
  inbox.show({});
  EXPECT_EQ(shown(left), std::vector<int>{19});
  EXPECT_EQ(shown(right), std::vector<int>{119});
}

TEST_F(InboxTest, ASampleOlderThanItsGreatestAgeIsNotShown) {
  InputPort& port = add({.name = "in", .max_age = seconds(0.1)});
  send(port, 1, Time{0});
  inbox.show(Time{} + seconds(0.1));
  EXPECT_EQ(shown(port), std::vector<int>{1});
  inbox.show(Time{} + seconds(0.2));
  EXPECT_TRUE(shown(port).empty());
  EXPECT_FALSE(port.fresh());
}

TEST_F(InboxTest, OfAQueueOnlyTheSamplesThatAreTooOldAreNotShown) {
  InputPort& port = add({.name = "in", .queue = 4, .max_age = seconds(0.1)});
  send(port, 1, Time{});
  send(port, 2, Time{} + seconds(0.15));
  inbox.show(Time{} + seconds(0.2));
  EXPECT_EQ(shown(port), std::vector<int>{2});
  EXPECT_TRUE(port.fresh());
}

TEST_F(InboxTest, ASampleThatIsStampedTooFarAheadIsNotShownAndIsCounted) {
  InputPort& port = add({.name = "in"});
  const Time now = Time{} + seconds(10);
  send(port, 1, now + seconds(0.09));
  inbox.show(now);
  EXPECT_EQ(shown(port), std::vector<int>{1}) << "clocks differ a little";
  EXPECT_EQ(inbox.ahead().samples, 0U);
  send(port, 2, now + seconds(3600));
  inbox.show(now);
  EXPECT_EQ(shown(port), std::vector<int>{});
  EXPECT_FALSE(port.fresh());
  EXPECT_EQ(inbox.ahead().samples, 1U);
  EXPECT_EQ(inbox.ahead().port, &port);
  EXPECT_EQ(inbox.ahead().by, seconds(3600));
}

TEST_F(InboxTest, WhatComesFromOutsideOfTheDeploymentIsJudgedByWhenItArrived) {
  InputPort& port = add({.name = "in", .outside = true, .max_age = seconds(0.1)});
  SampleRef sample = pool.loan();
  *static_cast<Stamped*>(sample.mutable_message()) = {Time{} + seconds(3600), 1};
  sample.mutable_info().published = Time{} + seconds(10);
  port.deliver(sample);
  inbox.show(Time{} + seconds(10.05));
  EXPECT_EQ(shown(port), std::vector<int>{1});
  inbox.show(Time{} + seconds(10.2));
  EXPECT_EQ(shown(port), std::vector<int>{});
}

}  // namespace
}  // namespace armature
