// SPDX-License-Identifier: Apache-2.0
#include "replay/message_difference.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <vector>

#include "armature/messages/known_types.hpp"
#include "armature/messages/sensor_msgs.hpp"
#include "armature/messages/tf2_msgs.hpp"

namespace armature {
namespace {

template <class Message>
std::optional<MessageDifference> difference_of(const Message& recorded, const Message& replayed) {
  const MessageType& type = message_type<Message>();
  std::vector<std::byte> first, second;
  type.encode(&recorded, first);
  type.encode(&replayed, second);
  return first_difference(*describe_type(type.dds_name), first, second);
}

msg::JointState joints(std::vector<double> position) {
  msg::JointState message;
  message.position_(std::move(position));
  return message;
}

TEST(MessageDifference, NamesTheElementAndHowFarNumbersAreApart) {
  const auto difference =
      difference_of(joints({1, 2, 3}), joints({1, std::nextafter(std::nextafter(2, 3), 3), 9}));
  ASSERT_TRUE(difference);
  EXPECT_EQ(difference->field, "position[1]");
  EXPECT_EQ(difference->recorded, "2");
  EXPECT_EQ(difference->replayed, "2.000000000000001");
  EXPECT_EQ(difference->ulps, 2U);
}

TEST(MessageDifference, CountsTheNumbersBetweenAlsoAcrossZero) {
  const double smallest = std::numeric_limits<double>::denorm_min();
  EXPECT_EQ(difference_of(joints({-smallest}), joints({smallest}))->ulps, 3U) << "-0, 0 and itself";
}

TEST(MessageDifference, NotANumberEqualsItself) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  EXPECT_FALSE(difference_of(joints({nan}), joints({nan})));
  EXPECT_TRUE(difference_of(joints({nan}), joints({1})));
}

TEST(MessageDifference, SaysWhatIsMissing) {
  const auto difference = difference_of(joints({1, 2}), joints({1}));
  ASSERT_TRUE(difference);
  EXPECT_EQ(difference->field, "position");
  EXPECT_EQ(difference->recorded, "2 elements");
  EXPECT_EQ(difference->replayed, "1");
  EXPECT_FALSE(difference->ulps);
}

TEST(MessageDifference, FindsFieldsBelowFields) {
  msg::TFMessage recorded;
  recorded.transforms_().resize(2);
  msg::TFMessage replayed = recorded;
  replayed.transforms_()[1].header_().frame_id_("base");
  const auto difference = difference_of(recorded, replayed);
  ASSERT_TRUE(difference);
  EXPECT_EQ(difference->field, "transforms[1].header.frame_id");
  EXPECT_EQ(difference->replayed, "\"base\"");
}

}  // namespace
}  // namespace armature
