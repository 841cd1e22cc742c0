// SPDX-License-Identifier: Apache-2.0
#include "armature/runtime/component/topic_name.hpp"

#include <gtest/gtest.h>

namespace armature {
namespace {

TEST(TopicName, IsWordsWithSlashesBetweenThem) {
  for (const char* name : {"clutch", "arm/measured_js", "/tf", "/left_2/Arm/measured_js", "_x"}) {
    EXPECT_FALSE(topic_name_defect(name)) << name;
  }
}

TEST(TopicName, IsNothingElse) {
  for (const char* name : {"", "/", "//tf", "arm/", "arm//measured_js", "arm measured", "2arm",
                           "arm/2", "arm-1", "~/arm", "{arm}", "arm\n", "\xc3\xa4rm"}) {
    EXPECT_TRUE(topic_name_defect(name)) << name;
  }
  EXPECT_EQ(topic_name_defect("arm/"),
            "'arm/' names no topic: words of letters, digits and _, not beginning with a digit, "
            "with / between them");
}

}  // namespace
}  // namespace armature
