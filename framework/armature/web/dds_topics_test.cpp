// SPDX-License-Identifier: Apache-2.0
// As what a topic is shown that several programs write as different types.
#include "armature/web/dds_topics.hpp"

#include <gmock/gmock.h>

#include <chrono>
#include <memory>
#include <string>
#include <string_view>
#include <thread>
#include <utility>
#include <vector>

#include "armature/bus/fast_dds/fast_dds_transport.hpp"
#include "armature/messages/armature_msgs.hpp"
#include "armature/runtime/testing/test_plugins.hpp"
#include "tests/dds_domain.hpp"

namespace armature {
namespace {

/// A program that writes a topic, as a part of the deployment that it says to be.
template <class Message>
class TopicWriter {
 public:
  TopicWriter(int domain, const std::string& deployment)
      : transport_{std::move(*FastDdsTransport::make({.network = {.domain = domain},
                                                      .deployment = deployment,
                                                      .fingerprint = std::string(64, '0'),
                                                      .now = [] { return Time{1}; }}))},
        writer_{std::move(*transport_->advertise(
            {"rt/lamp/component_states", &message_type<Message>(), QosProfile::state}))} {}

 private:
  std::unique_ptr<Transport> transport_;
  std::unique_ptr<RemoteWriter> writer_;
};

TEST(DdsTopicsTest, ATopicIsShownAsTheTypeOfTheDeploymentThatHasIt) {
  const int domain = unique_dds_domain();
  std::vector<std::string> conflicts;
  const DdsTopics topics{built_plugins(), {.domain = domain}, [&](const std::string& conflict) {
                           conflicts.push_back(conflict);
                         }};
  const TopicWriter<msg::TaskState> stranger{domain, "stranger"};
  const auto shown_type = [&] {
    for (const TopicSource::Topic& topic : topics.topics()) {
      if (topic.name == "/lamp/component_states") return topic.type;
    }
    return std::string{};
  };
  const auto is_shown_as = [&](std::string_view type) {
    for (int i = 0; i < 400 && shown_type() != type; ++i) {
      std::this_thread::sleep_for(std::chrono::milliseconds{50});
    }
    return shown_type() == type;
  };
  EXPECT_TRUE(is_shown_as(message_type<msg::TaskState>().dds_name)) << "nobody else writes it yet";
  const TopicWriter<msg::ComponentStates> lamp{domain, "lamp"};
  EXPECT_TRUE(is_shown_as(message_type<msg::ComponentStates>().dds_name));
  EXPECT_THAT(conflicts, testing::ElementsAre(testing::HasSubstr("deployment 'stranger'")))
      << "told once";
}

}  // namespace
}  // namespace armature
