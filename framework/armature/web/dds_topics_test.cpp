// SPDX-License-Identifier: Apache-2.0
// As what a topic is shown that several programs write, and whom of them is believed what.
#include "armature/web/dds_topics.hpp"

#include <gmock/gmock.h>

#include <algorithm>
#include <chrono>
#include <memory>
#include <mutex>
#include <set>
#include <string>
#include <string_view>
#include <thread>
#include <utility>
#include <vector>

#include "armature/bus/fast_dds/fast_dds_transport.hpp"
#include "armature/bus/sample.hpp"
#include "armature/messages/armature_msgs.hpp"
#include "armature/messages/rcl_interfaces.hpp"
#include "armature/runtime/testing/test_plugins.hpp"
#include "tests/dds_domain.hpp"

namespace armature {
namespace {

/// A program that writes a topic, as a part of the deployment that it says to be.
template <class Message>
class TopicWriter {
 public:
  TopicWriter(int domain, const std::string& deployment,
              const std::string& topic = "rt/lamp/component_states",
              QosProfile qos = QosProfile::state)
      : transport_{std::move(*FastDdsTransport::make({.network = {.domain = domain},
                                                      .deployment = deployment,
                                                      .fingerprint = std::string(64, '0'),
                                                      .now = [] { return Time{1}; }}))},
        samples_{message_type<Message>(), 16},
        writer_{std::move(*transport_->advertise({topic, &message_type<Message>(), qos}))} {}

  void write(const Message& message) {
    SampleRef sample = samples_.loan();
    *static_cast<Message*>(sample.mutable_message()) = message;
    sample.mutable_info().published = Time{1};
    writer_->offer(sample);
  }

 private:
  std::unique_ptr<Transport> transport_;
  SamplePool samples_;  // outlives the writer, which may still be sending
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

bool is_shown(const DdsTopics& topics, const std::string& name) {
  return std::ranges::count(topics.topics(), name, &TopicSource::Topic::name) == 1;
}

/// Waits long (a loaded machine), returns as soon as it can.
bool is_so_at_last(const auto& condition) {
  for (int i = 0; i < 400 && !condition(); ++i) {
    std::this_thread::sleep_for(std::chrono::milliseconds{50});
  }
  return condition();
}

TEST(DdsTopicsTest, AWriterThatOffersLessThanTheOneThatIsShownIsTold) {
  const int domain = unique_dds_domain();
  std::vector<std::string> told;
  const DdsTopics topics{
      built_plugins(), {.domain = domain}, [&](const std::string& line) { told.push_back(line); }};
  const TopicWriter<msg::TaskState> lamp{domain, "lamp", "rt/lamp/task", QosProfile::latched};
  const TopicWriter<msg::TaskState> stranger{domain, "stranger", "rt/lamp/task"};
  const auto tells = [&] {
    static_cast<void>(topics.topics());
    return !told.empty();
  };
  EXPECT_TRUE(is_so_at_last(tells));
  EXPECT_THAT(told,
              testing::ElementsAre(testing::AllOf(
                  testing::HasSubstr("deployment 'stranger'"),
                  testing::HasSubstr("writes '/lamp/task', too, with less QoS than the writer "
                                     "that is shown, and what that one writes is not"))));
}

TEST(DdsTopicsTest, NobodyButADeploymentIsBelievedHowItIsAndWhatIsSaidInItsName) {
  const int domain = unique_dds_domain();
  std::vector<std::string> told;
  std::mutex mutex;
  std::set<std::string> shown;
  DdsTopics topics{
      built_plugins(), {.domain = domain}, [&](const std::string& line) { told.push_back(line); }};
  TopicWriter<msg::ComponentStates> lamp{domain, "lamp"}, stranger{domain, "stranger"};
  TopicWriter<msg::Log> lamp_log{domain, "lamp", "rt/rosout"};
  TopicWriter<msg::Log> other_log{domain, "stranger", "rt/rosout"};
  ASSERT_TRUE(is_so_at_last(
      [&] { return is_shown(topics, "/lamp/component_states") && is_shown(topics, "/rosout"); }));
  const auto show = [&](const std::string& text) {
    const std::scoped_lock lock{mutex};
    shown.insert(text);
  };
  ASSERT_TRUE(topics.watch("/lamp/component_states", [&](const TopicSource::Message& message) {
    msg::ComponentStates states;
    ASSERT_TRUE(message_type<msg::ComponentStates>().decode(message.cdr, &states));
    show(states.process_());
  }));
  ASSERT_TRUE(topics.watch("/rosout", [&](const TopicSource::Message& message) {
    msg::Log log;
    ASSERT_TRUE(message_type<msg::Log>().decode(message.cdr, &log));
    show(log.name_() + ": " + log.msg_());
  }));
  const auto states_of = [](const char* process) {
    msg::ComponentStates states;
    states.process_(process);
    return states;
  };
  const auto line_of = [](const char* name, const char* text) {
    msg::Log log;
    log.name_(name);
    log.msg_(text);
    return log;
  };
  const std::set<std::string> believed{"main", "lamp.task: true", "stranger.task: true",
                                       "rviz.task: true"};
  const auto has_all = [&] {
    stranger.write(states_of("forged"));
    lamp.write(states_of("main"));
    other_log.write(line_of("lamp.task", "forged"));
    other_log.write(line_of("lamp", "forged"));
    other_log.write(line_of("stranger.task", "true"));
    other_log.write(line_of("rviz.task", "true"));
    lamp_log.write(line_of("lamp.task", "true"));
    const std::scoped_lock lock{mutex};
    return shown.size() >= believed.size();
  };
  EXPECT_TRUE(is_so_at_last(has_all));
  for (int i = 0; i < 10; ++i) {
    has_all();
    std::this_thread::sleep_for(std::chrono::milliseconds{20});
  }
  const auto tells = [&] {
    static_cast<void>(topics.topics());
    return told.size() >= 2;
  };
  EXPECT_TRUE(is_so_at_last(tells));
  EXPECT_THAT(told, testing::UnorderedElementsAre(
                        testing::AllOf(testing::HasSubstr("deployment 'stranger'"),
                                       testing::HasSubstr("'/lamp/component_states'")),
                        testing::AllOf(testing::HasSubstr("deployment 'stranger'"),
                                       testing::HasSubstr("'/rosout'"))));
  const std::scoped_lock lock{mutex};
  EXPECT_EQ(shown, believed);
}

TEST(DdsTopicsTest, ADeploymentThatSomebodyElseDescribesIsNone) {
  const int domain = unique_dds_domain();
  const DdsTopics topics{built_plugins(), {.domain = domain}, [](const std::string&) {}};
  const TopicWriter<msg::DeploymentDescription> liar{domain, "stranger", "rt/ghost/description"};
  const TopicWriter<msg::DeploymentDescription> played{domain, "", "rt/replay/lamp/description"};
  const TopicWriter<msg::DeploymentDescription> lamp{domain, "lamp", "rt/lamp/description"};
  const TopicWriter<msg::TaskState> other{domain, "stranger", "rt/tool/description"};
  for (const char* name : {"/lamp/description", "/replay/lamp/description", "/tool/description"}) {
    EXPECT_TRUE(is_so_at_last([&] { return is_shown(topics, name); })) << name;
  }
  EXPECT_FALSE(is_shown(topics, "/ghost/description"));
}

}  // namespace
}  // namespace armature
