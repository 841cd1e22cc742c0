// SPDX-License-Identifier: Apache-2.0
#include "armature/config/parameters/ports_struct.hpp"

#include <gtest/gtest.h>

#include "armature/config/document.hpp"

namespace armature {
namespace {

const std::vector<std::string> kMessageHeaders{
    "armature/messages/std_msgs.hpp", "armature/messages/sensor_msgs.hpp", "weather_msgs/sky.hpp"};

std::string ports_header_of(const std::string& ports,
                            const std::vector<std::string>& headers = kMessageHeaders) {
  config::Problems problems;
  const std::string header =
      ports_header(config::parse_text("id: task/lamp\n" + ports, "plugin.yaml"), headers, problems);
  problems.throw_if_any();
  return header;
}

std::string refusal_of_ports(const std::string& ports) {
  try {
    ports_header_of(ports);
  } catch (const config::ConfigError& error) {
    return error.what();
  }
  return "none";
}

TEST(TheStructOfPorts, HasAMemberOfItsTypeForEachPortAndClaimsThemAll) {
  EXPECT_EQ(ports_header_of(R"(
in:
  measured_js: {type: sensor_msgs/JointState, reads: queue(8), doc: "Where the arm\nis, in C:\\"}
  operator: {type: std_msgs/String, optional: true}
out:
  my-report: {type: weather_msgs/Report, doc: Of the sky}
)"),
            R"(// Made from the plugin.yaml of task/lamp: change it there.
#pragma once

#include "armature/messages/sensor_msgs.hpp"
#include "armature/messages/std_msgs.hpp"
#include "weather_msgs/sky.hpp"
#include "armature/runtime/component/setup.hpp"

namespace armature::task::lamp {

/// The ports of task/lamp.
struct Ports {
  /// Where the arm is, in C:\.
  Input<::sensor_msgs::msg::dds_::JointState_> measured_js;
  Input<::std_msgs::msg::dds_::String_> operator_;
  /// Of the sky
  Output<::weather_msgs::msg::dds_::Report_> my_report;

  explicit Ports(Setup& setup)
      : measured_js{setup.input<::sensor_msgs::msg::dds_::JointState_>("measured_js")},
        operator_{setup.input<::std_msgs::msg::dds_::String_>("operator")},
        my_report{setup.output<::weather_msgs::msg::dds_::Report_>("my-report")} {}
};

}  // namespace armature::task::lamp
)");
}

TEST(TheStructOfPorts, OfEachUnitHasThePortsOfThatUnit) {
  const std::string text = ports_header_of(R"(
units:
  slow_planner: {}
in:
  plan: {type: std_msgs/String}
  stop: {type: std_msgs/Bool, units: [main, slow_planner]}
out:
  plan: {type: std_msgs/String, units: [slow_planner]}
)");
  EXPECT_EQ(text.substr(text.find("\n/// The ports")), R"(
/// The ports of task/lamp.
struct Ports {
  Input<::std_msgs::msg::dds_::String_> plan;
  Input<::std_msgs::msg::dds_::Bool_> stop;

  explicit Ports(Setup& setup)
      : plan{setup.input<::std_msgs::msg::dds_::String_>("plan")},
        stop{setup.input<::std_msgs::msg::dds_::Bool_>("stop")} {}
};

/// The ports of task/lamp, unit slow_planner.
struct SlowPlannerPorts {
  Input<::std_msgs::msg::dds_::Bool_> stop;
  Output<::std_msgs::msg::dds_::String_> plan;

  explicit SlowPlannerPorts(Setup& setup)
      : stop{setup.input<::std_msgs::msg::dds_::Bool_>("stop")},
        plan{setup.output<::std_msgs::msg::dds_::String_>("plan")} {}
};

}  // namespace armature::task::lamp
)");
}

TEST(TheStructOfPorts, OfAComponentWithoutPortsIsEmpty) {
  const std::string text = ports_header_of("kind: component\n");
  EXPECT_NE(text.find("struct Ports {\n\n  explicit Ports(Setup&) {}\n};\n"), std::string::npos)
      << text;
}

TEST(TheStructOfPorts, IncludesEveryHeaderThatAPackageOfTheUsersMayBeIn) {
  const std::string text =
      ports_header_of("in:\n  sky: {type: weather_msgs/Report}\n",
                      {"armature/messages/std_msgs.hpp", "armature/messages/sensor_msgs.hpp",
                       "all_msgs/ground.hpp", "all_msgs/weather.hpp"});
  EXPECT_NE(text.find("#pragma once\n\n"
                      "#include \"all_msgs/ground.hpp\"\n#include \"all_msgs/weather.hpp\"\n"
                      "#include \"armature/runtime/component/setup.hpp\"\n"),
            std::string::npos)
      << text;
}

TEST(TheStructOfPorts, SaysWhenNoLibraryThatIsLinkedHasThePackage) {
  const std::string text = ports_header_of("in:\n  sky: {type: weather_msgs/Report}\n",
                                           {"armature/messages/std_msgs.hpp"});
  EXPECT_NE(text.find("#error \"no library that armature_add_plugin links has messages of "
                      "weather_msgs\"\n"),
            std::string::npos)
      << text;
}

TEST(TheStructOfPorts, IsNotMadeOfAPortWhoseTypeIsNone) {
  EXPECT_EQ(refusal_of_ports("in:\n  sky: {type: Report}\n"),
            "plugin.yaml:3:15: the type is 'Report', and must be package/Message");
  EXPECT_EQ(refusal_of_ports("out:\n  sky: {doc: Blue}\n"),
            "plugin.yaml:3:8: missing key 'type' in port 'sky'");
}

TEST(TheStructOfPorts, IsNotMadeOfTwoPortsThatWouldHaveOneMember) {
  EXPECT_EQ(refusal_of_ports("in:\n  my-sky: {type: std_msgs/Bool}\n"
                             "out:\n  my_sky: {type: std_msgs/Bool}\n"),
            "plugin.yaml:5:3: 'my-sky' and 'my_sky' are both 'my_sky' in the code of one unit; "
            "give one of them another name");
}

}  // namespace
}  // namespace armature
