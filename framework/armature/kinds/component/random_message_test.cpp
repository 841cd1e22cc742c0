// SPDX-License-Identifier: Apache-2.0
#include "armature/kinds/component/random_message.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "armature/messages/cdr_check.hpp"
#include "armature/messages/geometry_msgs.hpp"
#include "armature/messages/known_types.hpp"
#include "armature/messages/message_type.hpp"

namespace armature {
namespace {

TEST(RandomMessage, EveryTypeIsEncodedSuchThatItDecodes) {
  std::mt19937_64 random{3};
  for (const MessageType* type : known_message_types()) {
    SCOPED_TRACE(type->ros_name);
    const TypeDescription* description = describe_type(type->ros_name);
    ASSERT_TRUE(description);
    for (int round = 0; round < 50; ++round) {
      const auto cdr = random_message(*description, RandomNumbers::any, random);
      const auto checked = check_cdr(*description, cdr);
      ASSERT_TRUE(checked) << checked.error().text << ", seed 3, round " << round;
      void* message = type->create();
      EXPECT_TRUE(type->decode(cdr, message));
      type->destroy(message);
    }
  }
}

TEST(RandomMessage, NumbersThatAreNoneFillEveryField) {
  std::mt19937_64 random{3};
  const auto cdr =
      random_message(*describe_type("geometry_msgs/Point"), RandomNumbers::none, random);
  msg::Point point;
  ASSERT_TRUE(message_type<msg::Point>().decode(cdr, &point));
  EXPECT_TRUE(std::isnan(point.x_()) && std::isnan(point.y_()) && std::isnan(point.z_()));
}

}  // namespace
}  // namespace armature
