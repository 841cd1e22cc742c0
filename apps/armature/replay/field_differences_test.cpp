// SPDX-License-Identifier: Apache-2.0
#include "replay/field_differences.hpp"

#include <gtest/gtest.h>

#include <limits>
#include <string>
#include <utility>
#include <vector>

#include "armature/messages/sensor_msgs.hpp"
#include "armature/messages/trajectory_msgs.hpp"

namespace armature {
namespace {

constexpr double kNone = std::numeric_limits<double>::quiet_NaN();

class TopicDifferencesTest : public ::testing::Test {
 protected:
  template <class Message>
  void compare(const Message& before, const Message& now, double at_s) {
    differences_.compare(message_type<Message>(), encoded(before), encoded(now), at_s);
  }
  template <class Message>
  static std::vector<std::byte> encoded(const Message& message) {
    std::vector<std::byte> cdr;
    message_type<Message>().encode(&message, cdr);
    return cdr;
  }
  static msg::JointState joints(std::vector<double> position, const std::string& frame = "") {
    msg::JointState message;
    message.header_().frame_id_(frame);
    message.position_(std::move(position));
    return message;
  }

  TopicDifferences differences_;
};

TEST_F(TopicDifferencesTest, TellsTheLargestOfAFieldAndWhen) {
  compare(joints({1, 2}), joints({1, 2}), 0);
  compare(joints({1, 2}), joints({1.5, 2.25}), 1);
  compare(joints({1, 2}), joints({1.25, 2}), 2);
  EXPECT_EQ(differences_.messages(), 3U);
  EXPECT_EQ(differences_.differing(), 2U);
  ASSERT_EQ(differences_.fields().size(), 1U);
  const FieldDifferences& field = differences_.fields().at("position[]");
  EXPECT_EQ(field.messages, 2U) << "not its elements";
  EXPECT_EQ(field.largest, 0.5);
  EXPECT_EQ(field.at_s, 1);
}

TEST_F(TopicDifferencesTest, WhatIsNoNumberOnBothSidesIsEqualAndHidesNothing) {
  compare(joints({kNone, 1}), joints({kNone, 1.25}), 0);
  ASSERT_EQ(differences_.fields().size(), 1U);
  EXPECT_EQ(differences_.fields().at("position[]").largest, 0.25);
}

TEST_F(TopicDifferencesTest, ANumberThatIsNoneAnyMoreIsToldAsSuchAndHidesNothing) {
  compare(joints({1, 2, 3}), joints({kNone, 2.5, std::numeric_limits<double>::infinity()}), 7);
  EXPECT_EQ(differences_.fields().at("position[]").largest, 0.5);
  const FieldDifferences& none = differences_.fields().at("no number in position[]");
  EXPECT_FALSE(none.is_number);
  EXPECT_EQ(none.messages, 1U);
  EXPECT_EQ(none.before, "1");
  EXPECT_EQ(none.now, "nan");
  EXPECT_EQ(none.at_s, 7);
}

TEST_F(TopicDifferencesTest, TellsTheFirstTextsAndCountsOfElements) {
  compare(joints({1}, "base"), joints({1, 2}, "tool"), 0);
  compare(joints({1}, "base"), joints({1}, "camera"), 1);
  const FieldDifferences& text = differences_.fields().at("header.frame_id");
  EXPECT_EQ(text.before, "\"base\"");
  EXPECT_EQ(text.now, "\"tool\"");
  EXPECT_EQ(text.messages, 2U);
  EXPECT_EQ(differences_.fields().at("elements of position").now, "\"2\"");
}

TEST_F(TopicDifferencesTest, NamesTheFirstOctetThatDiffersHoweverFarBehind) {
  msg::Image picture;
  picture.data_().resize(400);
  msg::Image other = picture;
  other.data_()[398] = 7;
  other.data_()[399] = 8;
  compare(picture, other, 2);
  ASSERT_EQ(differences_.fields().size(), 1U);
  const FieldDifferences& octets = differences_.fields().at("data[]");
  EXPECT_EQ(octets.element, "data[398]");
  EXPECT_EQ(octets.before, "0");
  EXPECT_EQ(octets.now, "7");
  EXPECT_EQ(octets.messages, 1U);
}

TEST_F(TopicDifferencesTest, FollowsJointsFromMessageToMessage) {
  compare(joints({0, 1}), joints({0, 1}), 0);
  compare(joints({0.5, 1.25}), joints({0.5, 3}), 1);
  EXPECT_EQ(differences_.joint_steps()[0], 0.5);
  EXPECT_EQ(differences_.joint_steps()[1], 2);
}

TEST_F(TopicDifferencesTest, FollowsTheJointsOfEachWayByItself) {
  msg::JointTrajectory way;
  way.points_().resize(2);
  way.points_()[0].positions_({0});
  way.points_()[1].positions_({0.25});
  msg::JointTrajectory other = way;
  other.points_()[0].positions_({9});
  other.points_()[1].positions_({9});
  compare(way, way, 0);
  compare(other, other, 1);
  EXPECT_EQ(differences_.joint_steps()[0], 0.25);
}

TEST_F(TopicDifferencesTest, FollowsTheJointsOfMessagesThatOnlyOneRunHas) {
  compare(joints({0}), joints({0}), 0);
  differences_.add_only_now(message_type<msg::JointState>(), encoded(joints({2})));
  compare(joints({0.5}), joints({2.25}), 1);
  differences_.add_only_before(message_type<msg::JointState>(), encoded(joints({1.5})));
  EXPECT_EQ(differences_.only_now(), 1U);
  EXPECT_EQ(differences_.only_before(), 1U);
  EXPECT_EQ(differences_.joint_steps()[0], 1);
  EXPECT_EQ(differences_.joint_steps()[1], 2);
}

}  // namespace
}  // namespace armature
