// SPDX-License-Identifier: Apache-2.0
#include "armature/bus/fast_dds/egress.hpp"

#include <gtest/gtest.h>

#include <atomic>
#include <latch>
#include <thread>

#include "armature/bus/fast_dds/endpoint_tag.hpp"
#include "armature/messages/std_msgs.hpp"

namespace armature {
namespace {

class EgressTest : public testing::Test {
 protected:
  SampleRef sample(double value) {
    SampleRef made = pool_.loan();
    static_cast<msg::Float64*>(made.mutable_message())->data_(value);
    return made;
  }
  static double value(const SampleRef& sample) {
    return static_cast<const msg::Float64*>(sample.message())->data_();
  }
  SamplePool pool_{message_type<msg::Float64>(), 8};
};

TEST_F(EgressTest, AFullQueueDropsTheOldestAndCounts) {
  std::vector<double> sent;
  std::latch first_is_being_sent{1};
  std::latch go_on{1};
  {
    Egress egress;
    const auto queue = egress.open(2, [&](const SampleRef& s) {
      if (sent.empty()) {
        first_is_being_sent.count_down();
        go_on.wait();
      }
      sent.push_back(value(s));
    });
    queue->offer(sample(0));
    first_is_being_sent.wait();
    for (const double v : {1, 2, 3, 4}) queue->offer(sample(v));
    EXPECT_EQ(queue->dropped(), 2U);
    go_on.count_down();
  }
  EXPECT_EQ(sent, (std::vector<double>{0, 3, 4}));
}

TEST_F(EgressTest, WhatWaitsIsSentBeforeTheQueueGoes) {
  std::vector<double> sent;
  Egress egress;
  {
    const auto queue = egress.open(4, [&](const SampleRef& s) { sent.push_back(value(s)); });
    for (const double v : {1, 2, 3}) queue->offer(sample(v));
  }
  EXPECT_EQ(sent, (std::vector<double>{1, 2, 3}));
  EXPECT_EQ(pool_.grown(), 0U);
}

TEST_F(EgressTest, ASlowTopicDoesNotStarveTheOthers) {
  std::atomic<int> slow{0};
  std::latch fast_sent{1};
  Egress egress;
  const auto busy = egress.open(2, [&](const SampleRef&) { ++slow; });
  const auto quiet = egress.open(2, [&](const SampleRef&) { fast_sent.count_down(); });
  std::atomic<bool> stop{false};
  std::thread flood{[&] {
    while (!stop) busy->offer(sample(1));
  }};
  quiet->offer(sample(2));
  fast_sent.wait();
  stop = true;
  flood.join();
}

TEST_F(EgressTest, RunsOnANamedThread) {
  std::string name;
  {
    Egress egress;
    std::latch done{1};
    const auto queue = egress.open(1, [&](const SampleRef&) {
      char text[16] = {};
      pthread_getname_np(pthread_self(), text, sizeof text);
      name = text;
      done.count_down();
    });
    queue->offer(sample(1));
    done.wait();
  }
  EXPECT_EQ(name, "dds-egress");
}

TEST(EndpointTag, ComesBackFromUserData) {
  const EndpointTag tag{
      .ours = true, .deployment = "lamp", .fingerprint = "f0", .run = "1a", .layout = 0xab12};
  const std::string text = to_user_data(tag);
  EXPECT_EQ(text, "armature;deployment=lamp;fingerprint=f0;run=1a;layout=000000000000ab12");
  const std::vector<std::uint8_t> bytes{text.begin(), text.end()};
  const EndpointTag back = parse_endpoint_tag(bytes);
  EXPECT_TRUE(back.ours);
  EXPECT_EQ(back.deployment, "lamp");
  EXPECT_EQ(back.fingerprint, "f0");
  EXPECT_EQ(back.run, "1a");
  EXPECT_EQ(back.layout, 0xab12U);
}

TEST(EndpointTag, IsOfOneDeploymentWithEqualFingerprintAndRun) {
  const EndpointTag tag{.ours = true, .fingerprint = "f0", .run = "1a"};
  EXPECT_TRUE(same_deployment(tag, tag));
  EXPECT_FALSE(same_deployment(tag, {.ours = true, .fingerprint = "f1", .run = "1a"}));
  EXPECT_FALSE(same_deployment(tag, {.ours = true, .fingerprint = "f0", .run = "1b"}));
  EXPECT_FALSE(same_deployment(tag, {.ours = false, .fingerprint = "f0", .run = "1a"}));
}

TEST(EndpointTag, OfOtherProgramsIsNotOurs) {
  for (const std::string text : {"", "enclave=/;", "armature2;deployment=x", ";;;"}) {
    const std::vector<std::uint8_t> bytes{text.begin(), text.end()};
    EXPECT_FALSE(parse_endpoint_tag(bytes).ours) << text;
  }
}

}  // namespace
}  // namespace armature
