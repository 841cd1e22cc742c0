// SPDX-License-Identifier: Apache-2.0
// Samples of strangers are refused where the deployment itself writes; whatever cannot meet is
// reported by name.
#include "armature/bus/fast_dds/conflicts.hpp"

#include <gmock/gmock.h>

#include "armature/bus/fast_dds/fast_dds_test.hpp"

namespace armature {
namespace {

using namespace std::chrono_literals;
using testing::HasSubstr;
using testing::MatchesRegex;

const std::string kPlace = R"( \(pid [0-9]+ on [^)]+\))";

TEST_F(FastDds, CommandsOfTheSameDeploymentAreTaken) {
  Peer peer{domain_, "lamp", "f00d", "talk"};
  const auto transport = make_transport();
  const auto reader = transport->subscribe(command_, true, collect()).value();
  EXPECT_TRUE(eventually([&] { return received() > 3; }));
  EXPECT_EQ(events(Kind::foreign_writer), 0);
}

TEST_F(FastDds, CommandsOfAnotherDeploymentAreRefusedAndReported) {
  Peer stranger{domain_, "other", "beef", "talk"};
  const auto transport = make_transport();
  const auto reader = transport->subscribe(command_, true, collect()).value();
  EXPECT_THAT(event(Kind::foreign_writer),
              MatchesRegex("a writer of deployment 'other'" + kPlace +
                           R"( \(configuration beef\) was refused on '/test/from_peer': commands )"
                           R"(are taken only from deployment 'lamp' \(configuration f00d\))"));
  // A writer that is known to send: one of the right deployment gets through, the other never.
  Peer friend_{domain_, "lamp", "f00d", "talk"};
  ASSERT_TRUE(eventually([&] { return received() > 0; }));
  friend_.kill_now();
  ASSERT_TRUE(eventually([&] { return reader->writers() == 1; }));
  const std::size_t before = received();
  std::this_thread::sleep_for(100ms);  // ten samples of the stranger
  EXPECT_EQ(received(), before);
  EXPECT_EQ(events(Kind::foreign_writer), 1);
}

TEST_F(FastDds, SamplesOfStrangersAreRefusedNamedOnceAndCounted) {
  Peer stranger{domain_, "other", "beef", "talk"};
  const auto transport = make_transport();
  const auto reader = transport->subscribe(from_peer_, true, collect()).value();
  ASSERT_TRUE(eventually([&] {
    const auto refused = reader->refused();
    return !refused.empty() && refused.front().count > 3;
  }));
  EXPECT_EQ(received(), 0U);
  EXPECT_EQ(reader->refused().size(), 1U);
  EXPECT_THAT(
      reader->refused().front().writer,
      MatchesRegex("deployment 'other' \\(pid " + std::to_string(stranger.pid()) + " on [^)]+\\)"));
  EXPECT_THAT(event(Kind::foreign_writer),
              HasSubstr("was refused on '/test/from_peer': this input takes samples only from "
                        "deployment 'lamp' (configuration f00d); 'open:' in its file opens an "
                        "input to all"));
  EXPECT_EQ(events(Kind::foreign_writer), 1);
}

/// Deployment 'lamp' writes rt/lamp/beat, and so does a stranger.
class SecondWriter : public testing::Test {
 protected:
  void found() { discovery_.endpoint_found(stranger_); }
  void added(bool writes) {
    conflicts_.own_endpoint_added({.writes = writes, .topic = topic_}, discovery_);
  }

  const TopicSpec topic_{"rt/lamp/beat", &message_type<msg::JointState>(), QosProfile::state};
  const Endpoint stranger_{
      .guid = {}, .writes = true, .topic = topic_.name, .type = std::string{topic_.type->dds_name}};
  std::vector<std::string> reported_;
  Conflicts conflicts_{
      EndpointTag{.ours = true, .deployment = "lamp", .fingerprint = "f00d", .run = {}},
      [this](const TransportEvent& event) { reported_.push_back(event.text); }};
  Discovery discovery_{
      {.endpoint_found = [this](const Endpoint& other, const Discovery& discovery) {
        conflicts_.endpoint_found(other, discovery);
      }}};
};

TEST_F(SecondWriter, IsToldOnceWhoeverWasFirst) {
  found();
  added(true);
  ASSERT_EQ(reported_.size(), 1U);
  EXPECT_THAT(reported_.front(),
              HasSubstr("writes '/lamp/beat', too, which is this deployment's own: "
                        "nobody here hears it"));
  found();
  EXPECT_EQ(reported_.size(), 1U);
}

TEST_F(SecondWriter, IsToldWhenItComesLater) {
  added(true);
  EXPECT_TRUE(reported_.empty());
  found();
  EXPECT_EQ(reported_.size(), 1U);
}

TEST_F(SecondWriter, IsNoNewsWhereOneOfOurReadersTakesIt) {
  found();
  added(false);
  added(true);
  EXPECT_THAT(reported_, testing::IsEmpty());
}

TEST_F(FastDds, ASecondTypeOnATopicIsReported) {
  const auto transport = make_transport();
  const auto reader = transport->subscribe(from_peer_, false, collect()).value();
  Peer peer{domain_, "other", "beef", "talk_text"};
  EXPECT_THAT(event(Kind::type_conflict),
              MatchesRegex("a writer of deployment 'other'" + kPlace +
                           " uses the type std_msgs::msg::dds_::String_ on '/test/from_peer', our "
                           "reader uses sensor_msgs::msg::dds_::JointState_: they never meet"));
}

TEST_F(FastDds, ASecondTypeInTheSameProcessIsRefused) {
  const auto transport = make_transport();
  const auto writer = transport->advertise(to_peer_).value();
  const auto second =
      transport->advertise({"rt/test/to_peer", &message_type<msg::Image>(), QosProfile::state});
  ASSERT_FALSE(second);
  EXPECT_EQ(second.error().text,
            "topic '/test/to_peer' is used with the type sensor_msgs::msg::dds_::JointState_ and "
            "with sensor_msgs::msg::dds_::Image_ in this process");
}

TEST_F(FastDds, AnotherLayoutUnderTheSameNameIsReportedAndNotDecoded) {
  const auto transport = make_transport();
  const auto reader = transport->subscribe(from_peer_, false, collect()).value();
  Peer peer{domain_, "lamp", "f00d", "talk_other_layout"};
  EXPECT_THAT(event(Kind::layout_conflict),
              MatchesRegex("a writer of deployment 'lamp'" + kPlace +
                           " has another layout of sensor_msgs::msg::dds_::JointState_ on "
                           "'/test/from_peer' than this process: build both from the same idl/"));
  ASSERT_TRUE(eventually([&] { return reader->writers() == 1; }));
  std::this_thread::sleep_for(100ms);
  EXPECT_EQ(received(), 0U);
}

TEST_F(FastDds, QosThatCannotMeetIsReported) {
  const auto transport = make_transport();
  const auto writer = transport->advertise(to_peer_).value();
  Peer peer{domain_, "other", "beef", "latched_reader"};
  EXPECT_THAT(event(Kind::qos_conflict),
              MatchesRegex("a reader on '/test/to_peer' asks for more than our writer's profile "
                           "'state' offers: durability \\(readers there: deployment 'other'" +
                           kPlace + "\\)"));
}

}  // namespace
}  // namespace armature
