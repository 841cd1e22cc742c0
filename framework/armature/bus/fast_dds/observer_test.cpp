// SPDX-License-Identifier: Apache-2.0
// The observer sees and reads what it has no code for.
#include "armature/bus/fast_dds/observer.hpp"

#include <algorithm>
#include <atomic>
#include <cstddef>
#include <iterator>
#include <map>
#include <nlohmann/json.hpp>
#include <string>
#include <utility>

#include "armature/bus/fast_dds/fast_dds_test.hpp"
#include "armature/messages/cdr_to_json.hpp"
#include "armature/messages/known_types.hpp"

namespace armature {
namespace {

TEST_F(FastDds, TheObserverReadsATopicByItsName) {
  const auto transport = make_transport();
  const auto writer = transport->advertise(to_peer_).value();
  const auto reader = transport->subscribe(from_peer_, false, collect()).value();
  const auto observer = DdsObserver::make({.network = {.domain = domain_}}).value();
  std::mutex mutex;
  std::string shown;
  ASSERT_TRUE(observer->watch("/test/to_peer", seconds(30), [&](const ObservedSample& seen) {
    const std::scoped_lock lock{mutex};
    shown = cdr_to_json(*describe_type(seen.type), seen.cdr)->at("position").dump();
  }));
  ASSERT_TRUE(eventually([&] {
    writer->offer(sample(2.5));
    const std::scoped_lock lock{mutex};
    return !shown.empty();
  }));
  EXPECT_EQ(shown, "[2.5,-2.5]");

  ASSERT_TRUE(eventually([&] { return observer->topics().size() == 2; }));
  const auto topics = observer->topics();
  EXPECT_EQ(topics[0].name, "rt/test/from_peer");
  EXPECT_EQ(topics[0].readers, 1);
  EXPECT_EQ(topics[0].writers, 0);
  EXPECT_EQ(topics[1].name, "rt/test/to_peer");
  EXPECT_EQ(topics[1].writers, 1);
  EXPECT_EQ(topics[1].types, std::vector<std::string>{"sensor_msgs::msg::dds_::JointState_"});
  EXPECT_EQ(topics[1].deployments, std::vector<std::string>{"lamp"});
}

TEST_F(FastDds, TheObserverReadsATopicOnlyAsLongAsItIsWatched) {
  const auto transport = make_transport();
  const auto writer = transport->advertise(to_peer_).value();
  const auto observer = DdsObserver::make({.network = {.domain = domain_}}).value();
  std::atomic<int> count{0};
  const auto watch = [&] {
    return observer->watch("/test/to_peer", seconds(30), [&](const ObservedSample&) { ++count; });
  };
  const auto offered = [&](int before) {
    return eventually([&] {
      writer->offer(sample(1));
      return count > before;
    });
  };
  ASSERT_TRUE(watch());
  EXPECT_TRUE(offered(0));
  observer->unwatch("/test/to_peer");
  const int before = count;
  EXPECT_TRUE(eventually([&] { return writer->matched_readers() == 0; }));
  for (int i = 0; i < 10; ++i) writer->offer(sample(1));
  EXPECT_EQ(count, before);
  ASSERT_TRUE(watch());
  EXPECT_TRUE(offered(before));
}

TEST_F(FastDds, AWatchedTopicThatComesBackWithLessQosOrAnotherTypeIsWatchedAgain) {
  const auto observer = DdsObserver::make({.network = {.domain = domain_}}).value();
  std::mutex mutex;
  std::string read;  // the type of the last sample
  const auto note = [&](const ObservedSample& seen) {
    const std::scoped_lock lock{mutex};
    read = seen.type;
  };
  const auto offered = [&](RemoteWriter& writer, SamplePool& pool) {
    return eventually([&] {
      writer.offer(pool.loan());
      const std::scoped_lock lock{mutex};
      return read == pool.type().dds_name;
    });
  };
  const MessageType& image = message_type<msg::Image>();
  SamplePool images{image, 16};  // outlives its writer, which may still be sending
  const auto watches_again = [&] {
    std::vector<std::string> again;
    EXPECT_TRUE(eventually([&] { return !(again = observer->watch_again()).empty(); }));
    return again;
  };
  const std::vector<std::string> name{"rt/test/to_peer"};
  {
    const auto transport = make_transport();
    const auto latched = transport->advertise({name[0], &type_, QosProfile::latched}).value();
    ASSERT_TRUE(observer->watch("/test/to_peer", seconds(30), note));
    EXPECT_TRUE(offered(*latched, pool_));
    EXPECT_TRUE(observer->watch_again().empty()) << "its writer is heard";
  }
  {
    const auto transport = make_transport();
    const auto state = transport->advertise({name[0], &type_, QosProfile::state}).value();
    EXPECT_EQ(watches_again(), name);
    read.clear();
    EXPECT_TRUE(offered(*state, pool_));
  }
  const auto transport = make_transport();
  const auto other = transport->advertise({name[0], &image, QosProfile::state}).value();
  EXPECT_EQ(watches_again(), name);
  EXPECT_TRUE(offered(*other, images));
  observer->unwatch("/test/to_peer");
  EXPECT_TRUE(eventually([&] { return other->matched_readers() == 0; }));
}

TEST_F(FastDds, TheObserverSaysWhichWritersItsReaderDoesNotHear) {
  const auto observer = DdsObserver::make({.network = {.domain = domain_}}).value();
  // A participant writes a topic as one type.
  const auto transport = make_transport(), another = make_transport();
  const std::string name = "rt/test/to_peer";
  /// By the type of a writer, and whether it keeps samples for those who come later.
  using Heard = std::map<std::pair<std::string, bool>, bool>;
  const auto heard_of = [&](std::size_t writers) {
    Heard heard;
    EXPECT_TRUE(eventually([&] {
      heard.clear();
      for (const ObservedTopic& topic : observer->topics()) {
        for (const ObservedEndpoint& one : topic.endpoints) {
          if (one.writes) heard[{one.type, one.transient_local}] = one.is_heard;
        }
      }
      return heard.size() == writers;
    }));
    return heard;
  };
  const auto watch = [&] {
    return observer->watch("/test/to_peer", seconds(30), [](const ObservedSample&) {}).has_value();
  };
  const MessageType& image = message_type<msg::Image>();
  const std::string type{type_.dds_name}, other{image.dds_name};
  {
    const auto state = transport->advertise({name, &type_, QosProfile::state}).value();
    ASSERT_TRUE(watch());
    const auto latched = transport->advertise({name, &type_, QosProfile::latched}).value();
    EXPECT_EQ(heard_of(2), (Heard{{{type, false}, true}, {{type, true}, true}}));
  }
  observer->unwatch("/test/to_peer");
  heard_of(0);
  const auto latched = transport->advertise({name, &type_, QosProfile::latched}).value();
  ASSERT_TRUE(watch());
  const auto state = transport->advertise({name, &type_, QosProfile::state}).value();
  const auto image_writer = another->advertise({name, &image, QosProfile::state}).value();
  EXPECT_EQ(heard_of(3),
            (Heard{{{type, false}, false}, {{type, true}, true}, {{other, false}, false}}));
}

TEST_F(FastDds, AWatchedTopicIsReadLikeTheDeploymentThatHasItAsSoonAsThatWritesIt) {
  const auto observer = DdsObserver::make({.network = {.domain = domain_}}).value();
  const auto stranger = make_transport();
  const auto early = stranger->advertise({"rt/test/to_peer", &type_, QosProfile::state}).value();
  std::mutex mutex;
  std::string read;  // the type of the last sample
  ASSERT_TRUE(observer->watch("/test/to_peer", seconds(30), [&](const ObservedSample& seen) {
    const std::scoped_lock lock{mutex};
    read = seen.type;
  }));
  const MessageType& image = message_type<msg::Image>();
  SamplePool images{image, 16};
  const auto transport = FastDdsTransport::make({.network = {.domain = domain_},
                                                 .deployment = "test",
                                                 .fingerprint = "f00d",
                                                 .now = system_now})
                             .value();
  const auto own = transport->advertise({"rt/test/to_peer", &image, QosProfile::state}).value();
  std::vector<std::string> again;
  EXPECT_TRUE(eventually([&] { return !(again = observer->watch_again()).empty(); }));
  EXPECT_EQ(again, std::vector<std::string>{"rt/test/to_peer"});
  EXPECT_TRUE(eventually([&] {
    own->offer(images.loan());
    const std::scoped_lock lock{mutex};
    return read == image.dds_name;
  }));
  EXPECT_TRUE(observer->watch_again().empty()) << "though the stranger is still there";
}

TEST_F(FastDds, ATopicWithASlashInFrontIsNotTakenForTheOneOfRosOfThatName) {
  const auto transport = make_transport();
  const auto other = transport->advertise({"/test/to_peer", &type_, QosProfile::state}).value();
  const auto writer = transport->advertise(to_peer_).value();
  const auto observer = DdsObserver::make({.network = {.domain = domain_}}).value();
  const auto is_seen = [&](const char* name) {
    return std::ranges::count(observer->topics(), name, &ObservedTopic::name) == 1;
  };
  ASSERT_TRUE(eventually([&] { return is_seen("rt/test/to_peer"); }));
  std::mutex mutex;
  std::vector<std::string> shown;
  ASSERT_TRUE(observer->watch("/test/to_peer", seconds(30), [&](const ObservedSample& seen) {
    const std::scoped_lock lock{mutex};
    shown.push_back(cdr_to_json(*describe_type(seen.type), seen.cdr)->at("position").dump());
  }));
  ASSERT_TRUE(eventually([&] {
    other->offer(sample(1));
    writer->offer(sample(2.5));
    const std::scoped_lock lock{mutex};
    return shown.size() > 10;
  }));
  const std::scoped_lock lock{mutex};
  EXPECT_EQ(std::ranges::count(shown, "[2.5,-2.5]"), std::ssize(shown));
  EXPECT_FALSE(is_seen("/test/to_peer")) << "both would have the same name";
}

TEST_F(FastDds, ATopicOfAnotherProgramIsReadByTheNameThatItHasInDds) {
  const auto transport = make_transport();
  const auto observer = DdsObserver::make({.network = {.domain = domain_}}).value();
  const auto writer = transport->advertise({"chatter", &type_, QosProfile::state}).value();
  std::atomic<int> count{0};
  const auto watch = [&](const char* name, Duration timeout) {
    return observer->watch(name, timeout, [&](const ObservedSample&) { ++count; });
  };
  EXPECT_TRUE(watch("chatter", seconds(30)));
  EXPECT_TRUE(eventually([&] {
    writer->offer(sample(1));
    return count > 0;
  }));
  EXPECT_FALSE(watch("/chatter", seconds(0.1))) << "that is rt/chatter";
  observer->unwatch("chatter");
  EXPECT_TRUE(eventually([&] { return writer->matched_readers() == 0; }));
}

TEST_F(FastDds, AnUnwrittenTopicIsRefusedByTheObserver) {
  const auto observer = DdsObserver::make({.network = {.domain = domain_}}).value();
  const auto watched = observer->watch("/none", seconds(0.1), [](const ObservedSample&) {});
  ASSERT_FALSE(watched);
  EXPECT_EQ(watched.error().text, "nobody writes '/none'");
}

}  // namespace
}  // namespace armature
