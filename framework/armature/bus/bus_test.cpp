// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <set>
#include <vector>

#include "armature/bus/topic.hpp"

namespace armature {
namespace {

int g_created = 0;

MessageType number_type() {
  MessageType type;
  type.ros_name = "test_msgs/Number";
  type.create = [] {
    ++g_created;
    return static_cast<void*>(new int{});
  };
  type.destroy = [](void* message) {
    --g_created;
    delete static_cast<int*>(message);
  };
  return type;
}

struct Keeper : Subscriber {
  void deliver(const SampleRef& sample) override { samples.push_back(sample); }
  std::vector<SampleRef> samples;
};

class TopicTest : public testing::Test {
 protected:
  MessageType type = number_type();
  Topic topic{{.name = "rt/number", .type = &type}, 2};

  void publish(int value, Time now = {}) {
    SampleRef sample = topic.loan();
    *static_cast<int*>(sample.mutable_message()) = value;
    topic.publish(std::move(sample), now);
  }
};

TEST_F(TopicTest, HandsOneSampleByPointerToEverySubscriber) {
  Keeper first, second;
  topic.connect(first);
  topic.connect(second);
  publish(7);
  ASSERT_EQ(first.samples.size(), 1U);
  EXPECT_EQ(first.samples[0].message(), second.samples[0].message());
  EXPECT_EQ(*static_cast<const int*>(first.samples[0].message()), 7);
}

TEST_F(TopicTest, HandsASampleOfAnotherProcessOnlyToTheSubscribersItWasReadFor) {
  Keeper own, open;
  topic.connect(own);
  topic.connect(open, Sources::any);
  topic.deliver(topic.loan(), Sources::any);
  EXPECT_EQ(own.samples.size(), 0U);
  EXPECT_EQ(open.samples.size(), 1U);
  topic.deliver(topic.loan(), Sources::deployment);
  EXPECT_EQ(own.samples.size(), 1U);
  EXPECT_EQ(open.samples.size(), 1U);
}

TEST_F(TopicTest, PassesOnToTheSubscribersOfTheTopicThatItIsAPartOf) {
  Keeper keeper;
  Topic hub{{.name = "rt/number", .type = &type}, 2};
  hub.connect(keeper);
  Topic other{{.name = "rt/number", .type = &type}, 2};
  for (Topic* part : {&topic, &other}) part->pass_on_to(hub);
  publish(7);
  other.publish(other.loan(), Time{});
  ASSERT_EQ(keeper.samples.size(), 2U);
  EXPECT_EQ(*static_cast<const int*>(keeper.samples[0].message()), 7);
  EXPECT_EQ(keeper.samples[1].info().sequence, 1U) << "every writer counts its own";
  keeper.samples.clear();
}

TEST_F(TopicTest, KnowsWhetherASampleWouldReachSomebody) {
  struct Remote final : RemoteWriter {
    explicit Remote(const int& count) : count_{count} {}
    void offer(const SampleRef&) override {}
    int matched_readers() const override { return count_; }
    int peers() const override { return 0; }
    std::uint64_t dropped() const override { return 0; }
    std::vector<Watcher> who_watches() const override { return {}; }
    bool acknowledged(Duration) override { return true; }
    const int& count_;
  };
  int watching = 0;
  topic.attach(std::make_unique<Remote>(watching));
  EXPECT_FALSE(topic.has_readers());
  watching = 1;
  EXPECT_TRUE(topic.has_readers());
  watching = 0;

  Topic hub{{.name = "rt/number", .type = &type}, 2};
  topic.pass_on_to(hub);
  EXPECT_FALSE(topic.has_readers());
  Keeper keeper;
  hub.connect(keeper);
  EXPECT_TRUE(topic.has_readers());
}

TEST_F(TopicTest, NumbersSamplesFromOneAndStampsThem) {
  Keeper keeper;
  topic.connect(keeper);
  publish(1, Time{10});
  publish(2, Time{20});
  EXPECT_EQ(keeper.samples[0].info().sequence, 1U);
  EXPECT_EQ(keeper.samples[1].info().sequence, 2U);
  EXPECT_EQ(keeper.samples[1].info().published.ns, 20);
}

TEST_F(TopicTest, ReusesBlocksWhenNobodyHoldsThem) {
  for (int i = 0; i < 100; ++i) publish(i);
  EXPECT_EQ(topic.pool_growth(), 0U);
}

TEST_F(TopicTest, GrowsAndCountsWhenEverySampleIsHeld) {
  Keeper keeper;
  topic.connect(keeper);
  for (int i = 0; i < 5; ++i) publish(i);
  EXPECT_EQ(topic.pool_growth(), 3U);
  for (int i = 0; i < 5; ++i) {
    EXPECT_EQ(*static_cast<const int*>(keeper.samples[static_cast<std::size_t>(i)].message()), i);
  }
}

TEST(SamplePool, DestroysEveryMessageItMade) {
  g_created = 0;
  const MessageType type = number_type();
  {
    SamplePool pool{type, 3};
    EXPECT_EQ(g_created, 3);
    const SampleRef one = pool.loan();
    const SampleRef copy = one;
    EXPECT_EQ(one.message(), copy.message());
  }
  EXPECT_EQ(g_created, 0);
}

TEST(SamplePool, OfPicturesUsesTheBlockThatCameBackLast) {
  EXPECT_EQ(reuse_for(QosProfile::sensor), Reuse::newest);
  EXPECT_EQ(reuse_for(QosProfile::state), Reuse::in_turn);
  const MessageType type = number_type();
  SamplePool pool{type, 3, Reuse::newest};
  const void* last = nullptr;
  {
    const SampleRef first = pool.loan(), second = pool.loan(), third = pool.loan();
    last = first.message();
  }
  for (int i = 0; i < 3; ++i) EXPECT_EQ(pool.loan().message(), last);
  const SampleRef a = pool.loan(), b = pool.loan(), c = pool.loan();
  EXPECT_EQ(pool.grown(), 0U);
}

TEST(SamplePool, UsesItsBlocksInTurnSoThatEachHasTheMemoryItNeeds) {
  const MessageType type = number_type();
  SamplePool pool{type, 3};
  std::set<const void*> used;
  for (int i = 0; i < 3; ++i) used.insert(pool.loan().message());
  EXPECT_EQ(used.size(), 3U);
  {
    std::vector<SampleRef> out;
    for (int i = 0; i < 4; ++i) out.push_back(pool.loan());
  }
  for (int i = 0; i < 4; ++i) used.insert(pool.loan().message());
  EXPECT_EQ(used.size(), 4U) << "with the one that was allocated meanwhile";
  EXPECT_EQ(pool.grown(), 1U);
}

TEST(QosProfiles, HaveANameThatFindsThemAgain) {
  for (const QosProfile profile : {QosProfile::sensor, QosProfile::state, QosProfile::command,
                                   QosProfile::reply, QosProfile::latched}) {
    EXPECT_EQ(find_qos_profile(to_string(profile)), profile);
  }
  EXPECT_EQ(find_qos_profile("sensro"), std::nullopt);
}

TEST(QosProfiles, LetCommandsExpireAndKeepLatchedOnes) {
  EXPECT_GT(settings(QosProfile::command).lifespan.count(), 0);
  EXPECT_FALSE(settings(QosProfile::command).transient_local);
  EXPECT_TRUE(settings(QosProfile::latched).transient_local);
}

TEST(QosProfiles, KeepAReplyForAReaderThatIsDiscoveredAMomentLater) {
  EXPECT_TRUE(settings(QosProfile::reply).transient_local);
  EXPECT_GT(settings(QosProfile::reply).depth, 1) << "more than one may have asked";
  EXPECT_GT(settings(QosProfile::reply).lifespan.count(), 0) << "but not for the next program";
}

}  // namespace
}  // namespace armature
