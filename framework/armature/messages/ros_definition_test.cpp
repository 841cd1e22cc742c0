// SPDX-License-Identifier: Apache-2.0
#include "armature/messages/ros_definition.hpp"

#include <gtest/gtest.h>

#include "armature/messages/known_types.hpp"

namespace armature {
namespace {

TEST(RosDefinition, IsTheMsgTextOfATypeAndOfThoseInIt) {
  const TypeDescription& type = *describe_type("sensor_msgs/JointState");
  EXPECT_EQ(ros2_name(type), "sensor_msgs/msg/JointState");
  const std::string line(80, '=');
  EXPECT_EQ(ros_definition(type),
            "std_msgs/Header header\nstring[] name\nfloat64[] position\nfloat64[] velocity\n"
            "float64[] effort\n" +
                line + "\nMSG: std_msgs/Header\nbuiltin_interfaces/Time stamp\nstring frame_id\n" +
                line + "\nMSG: builtin_interfaces/Time\nint32 sec\nuint32 nanosec\n");
}

TEST(RosDefinition, HasEveryTypeOnce) {
  const std::string text = ros_definition(*describe_type("armature_msgs/DeploymentDescription"));
  const std::string port = "MSG: armature_msgs/PortDescription\n";
  const std::size_t first = text.find(port);
  ASSERT_NE(first, std::string::npos);
  EXPECT_EQ(text.find(port, first + 1), std::string::npos);
  EXPECT_NE(text.find("armature_msgs/ComponentDescription[] components\n"), std::string::npos);
}

TEST(RosDefinition, TellsTheLengthOfArrays) {
  const TypeDescription& info = *describe_type("sensor_msgs/CameraInfo");
  EXPECT_NE(ros_definition(info).find("float64[9] k\n"), std::string::npos);
}

}  // namespace
}  // namespace armature
