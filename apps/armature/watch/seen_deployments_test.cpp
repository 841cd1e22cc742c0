// SPDX-License-Identifier: Apache-2.0
#include "watch/seen_deployments.hpp"

#include <gmock/gmock.h>

#include <algorithm>
#include <chrono>
#include <memory>
#include <string>
#include <thread>
#include <utility>

#include "armature/bus/fast_dds/fast_dds_transport.hpp"
#include "armature/bus/sample.hpp"
#include "exit_code.hpp"
#include "inspect/graph_drawing.hpp"
#include "tests/dds_domain.hpp"
#include "watch/live_graph.hpp"

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

/// A program that writes one message on a topic, again and again.
class Teller {
 public:
  template <class Message>
  Teller(int domain, const std::string& deployment, const std::string& topic, Message message)
      : transport_{std::move(*FastDdsTransport::make({.network = {.domain = domain},
                                                      .deployment = deployment,
                                                      .fingerprint = std::string(64, '0'),
                                                      .now = [] { return Time{1}; }}))},
        samples_{message_type<Message>(), 4},
        writer_{std::move(
            *transport_->advertise({topic, &message_type<Message>(), QosProfile::state}))},
        thread_{[this, message = std::move(message)](const std::stop_token& ended) {
          while (!ended.stop_requested()) {
            SampleRef sample = samples_.loan();
            *static_cast<Message*>(sample.mutable_message()) = message;
            sample.mutable_info().published = Time{1};
            writer_->offer(sample);
            std::this_thread::sleep_for(std::chrono::milliseconds{10});
          }
        }} {}

 private:
  std::unique_ptr<Transport> transport_;
  SamplePool samples_;
  std::unique_ptr<RemoteWriter> writer_;
  std::jthread thread_;
};

msg::ComponentStates states_of(const std::string& component, const std::string& reason) {
  msg::ComponentStates states;
  states.process_("main");
  states.components_().resize(1);
  states.components_()[0].component_(component);
  states.components_()[0].reason_(reason);
  return states;
}

msg::DeploymentDescription description_of(const std::string& deployment) {
  msg::DeploymentDescription description;
  description.deployment_(deployment);
  description.process_("main");
  description.processes_({"main"});
  return description;
}

class SeenDeploymentsTest : public testing::Test {
 protected:
  /// Looks until that is so; false: it is not within 20 s.
  bool eventually(const auto& is_so) {
    for (int i = 0; i < 400; ++i) {
      seen_.look();
      if (is_so()) return true;
      std::this_thread::sleep_for(std::chrono::milliseconds{50});
    }
    return false;
  }
  bool is_noted(const std::string& what) {
    const auto notes = seen_.notes();
    return std::ranges::any_of(
        notes, [&](const auto& note) { return note.find(what) != std::string::npos; });
  }

  const int domain_ = unique_dds_domain();
  SeenDeployments seen_{{.network = {.domain = domain_}}, ""};
};

TEST_F(SeenDeploymentsTest, AWriterOfAnotherTypeHidesNoDeployment) {
  const Teller stranger{domain_, "stranger", "rt/lamp/component_states", msg::TaskState{}};
  std::this_thread::sleep_for(std::chrono::milliseconds{200});
  const Teller lamp{domain_, "lamp", "rt/lamp/component_states", states_of("arm", "")};
  EXPECT_TRUE(eventually([&] { return !seen_.all()["lamp"].components.empty(); }));
  EXPECT_TRUE(eventually([&] { return is_noted("deployment 'stranger'"); }));
  EXPECT_THAT(seen_.notes(), testing::ElementsAre(testing::HasSubstr(
                                 "writes '/lamp/component_states' and is no part of deployment "
                                 "'lamp' that this program knows: what it tells is not taken")));
}

TEST_F(SeenDeploymentsTest, BelievesNobodyButTheDeploymentItself) {
  const Teller lamp{domain_, "lamp", "rt/lamp/component_states", states_of("arm", "too hot")};
  const Teller stranger{domain_, "stranger", "rt/lamp/component_states", states_of("ghost", "")};
  const Teller liar{domain_, "stranger", "rt/lamp/description", description_of("lamp")};
  EXPECT_TRUE(eventually([&] { return !seen_.all()["lamp"].components.empty(); }));
  EXPECT_TRUE(eventually([&] { return seen_.notes().size() == 2; }));
  for (int i = 0; i < 20; ++i) {
    const SeenDeployment seen = seen_.all()["lamp"];
    ASSERT_EQ(seen.components.size(), 1U);
    EXPECT_EQ(seen.components.begin()->second.state.component_(), "arm");
    EXPECT_TRUE(seen.processes.empty());
    std::this_thread::sleep_for(std::chrono::milliseconds{20});
  }
}

TEST_F(SeenDeploymentsTest, ADescriptionOfAnotherDeploymentThanItsTopicsIsNotTaken) {
  const Teller lamp{domain_, "lamp", "rt/lamp/description", description_of("lamp")};
  const Teller other{domain_, "other", "rt/other/description", description_of("lamp")};
  EXPECT_TRUE(
      eventually([&] { return is_noted("describes deployment 'lamp' on the topic of 'other'"); }));
  EXPECT_TRUE(eventually([&] { return seen_.all()["lamp"].is_whole(); }));
  EXPECT_FALSE(seen_.all().contains("other"));
}

TEST(LiveGraph, OfADeploymentWithoutTopicsIsEmpty) {
  const int domain = unique_dds_domain();
  const Teller lamp{domain, "lamp", "rt/lamp/description", description_of("lamp")};
  testing::internal::CaptureStdout();
  const int code =
      draw_live_graph({.network = {.domain = domain}, .timeout_s = 20}, "lamp", GraphFormat::text);
  EXPECT_EQ(testing::internal::GetCapturedStdout(), "");
  EXPECT_EQ(code, kOk);
}

}  // namespace
}  // namespace armature
