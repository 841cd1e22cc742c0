// SPDX-License-Identifier: Apache-2.0
// Commands of another deployment are refused; whatever cannot meet is reported by name.
#include "armature/bus/fast_dds/fast_dds_test.hpp"

namespace armature {
namespace {

using namespace std::chrono_literals;

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
  EXPECT_EQ(event(Kind::foreign_writer),
            "a writer of deployment 'other' (configuration beef) was refused on "
            "'/test/from_peer': commands are taken only from deployment 'lamp' (configuration "
            "f00d)");
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

TEST_F(FastDds, ASecondTypeOnATopicIsReported) {
  const auto transport = make_transport();
  const auto reader = transport->subscribe(from_peer_, false, collect()).value();
  Peer peer{domain_, "other", "beef", "talk_text"};
  EXPECT_EQ(event(Kind::type_conflict),
            "a writer of deployment 'other' uses the type std_msgs::msg::dds_::String_ on "
            "'/test/from_peer', our reader uses sensor_msgs::msg::dds_::JointState_: they never "
            "meet");
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
  EXPECT_EQ(event(Kind::layout_conflict),
            "a writer of deployment 'lamp' has another layout of "
            "sensor_msgs::msg::dds_::JointState_ on '/test/from_peer' than this process: build "
            "both from the same idl/");
  ASSERT_TRUE(eventually([&] { return reader->writers() == 1; }));
  std::this_thread::sleep_for(100ms);
  EXPECT_EQ(received(), 0U);
}

TEST_F(FastDds, QosThatCannotMeetIsReported) {
  const auto transport = make_transport();
  const auto writer = transport->advertise(to_peer_).value();
  Peer peer{domain_, "other", "beef", "latched_reader"};
  EXPECT_EQ(event(Kind::qos_conflict),
            "a reader on '/test/to_peer' asks for more than our writer's profile 'state' offers: "
            "durability (readers there: deployment 'other')");
}

}  // namespace
}  // namespace armature
