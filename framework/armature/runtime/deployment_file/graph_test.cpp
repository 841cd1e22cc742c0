// SPDX-License-Identifier: Apache-2.0
// How components may be wired: one writer to a topic, or several that share it.
#include "armature/runtime/deployment_file/graph.hpp"

#include <gtest/gtest.h>

#include "armature/config/problems.hpp"

namespace armature {
namespace {

PortBinding port(const std::string& name, const std::string& topic, bool shared,
                 const std::string& type = "tf2_msgs/TFMessage") {
  PortBinding binding;
  binding.spec = {.name = name, .type = type, .shared = shared};
  binding.topic = topic;
  return binding;
}

ComponentConfig writer(const std::string& name, const PortBinding& output) {
  ComponentConfig component;
  component.name = name;
  component.outputs = {output};
  return component;
}

ComponentConfig reader(const std::string& name, const PortBinding& input) {
  ComponentConfig component;
  component.name = name;
  component.inputs = {input};
  return component;
}

/// The problems of a deployment of these components; their places are set.
std::vector<std::string> check(std::vector<ComponentConfig>& components) {
  DeploymentConfig deployment;
  deployment.components = components;
  config::Problems problems;
  check_graph(deployment, PluginRegistry{{}}, problems);
  components = deployment.components;
  std::vector<std::string> messages;
  for (const auto& problem : problems.sorted()) messages.push_back(problem.message);
  return messages;
}

using Messages = std::vector<std::string>;

TEST(Graph, ATopicHasOneWriter) {
  std::vector components{writer("a", port("x", "/t", false)), writer("b", port("y", "/t", false))};
  EXPECT_EQ(
      check(components),
      Messages{
          "a.x and b.y both write topic '/t'; give one of them others with 'topics:' or 'out:'"});
}

TEST(Graph, ATopicThatItsWritersShareHasSeveral) {
  std::vector components{reader("r", port("in", "/tf", false)), writer("a", port("x", "/tf", true)),
                         writer("b", port("y", "/tf", true))};
  EXPECT_EQ(check(components), Messages{});
  EXPECT_EQ(components[0].place, 2) << "a reader comes after all of them";
}

TEST(Graph, AWriterThatDoesNotShareATopicIsNotTakenIn) {
  std::vector components{writer("a", port("x", "/tf", true)), writer("b", port("y", "/tf", false))};
  EXPECT_EQ(
      check(components),
      Messages{
          "a.x and b.y both write topic '/tf'; give one of them others with 'topics:' or 'out:'"});
}

TEST(Graph, WritersThatShareATopicWriteOneType) {
  std::vector components{writer("a", port("x", "/tf", true)),
                         writer("b", port("y", "/tf", true, "std_msgs/String"))};
  EXPECT_EQ(check(components),
            Messages{"a.x and b.y both write topic '/tf', as 'tf2_msgs/TFMessage' and as "
                     "'std_msgs/String'; give one of them others with 'topics:' or 'out:'"});
}

TEST(Graph, WhatIsOfOneRobotIsNotReadAsAnothers) {
  PortBinding joints = port("js", "/js", false);
  joints.spec.of = "robot";
  std::vector components{writer("arm", joints), reader("motion", joints)};
  components[0].documents["robots"] = "left";
  EXPECT_EQ(check(components), Messages{}) << "the reader may take any robot's";
  components[1].documents["robots"] = "right";
  EXPECT_EQ(check(components),
            Messages{"motion.js reads values of robot 'right' from topic '/js', but arm.js writes "
                     "values of robot 'left'"});
  components[1].documents["robots"] = "left";
  EXPECT_EQ(check(components), Messages{});
  components[1].documents["robots"] = "right";
  components[1].inputs[0].spec.of = "";
  EXPECT_EQ(check(components), Messages{}) << "not of the reader's own robot";
}

TEST(Graph, ACommandIsReadFromACommandOnly) {
  PortBinding command = port("goal", "/goal", false);
  command.spec.qos = QosProfile::command;
  std::vector components{writer("task", port("goal", "/goal", false)), reader("motion", command)};
  EXPECT_EQ(check(components), Messages{"motion.goal reads QoS 'command' from topic '/goal', but "
                                        "task.goal writes QoS 'state'"});
  components[0].outputs[0].spec.qos = QosProfile::command;
  EXPECT_EQ(check(components), Messages{});
  components[1].inputs[0].spec.qos = QosProfile::state;
  EXPECT_EQ(check(components), Messages{}) << "who only watches may be late";
}

TEST(Graph, AnOptionalInputNeedsAWriterOnlyWhenTheFileSaysWhich) {
  PortBinding input = port("in", "/nowhere", false);
  input.spec.optional = true;
  std::vector components{reader("r", input)};
  EXPECT_EQ(check(components), Messages{});
  components[0].inputs[0].renamed = true;
  EXPECT_EQ(check(components), Messages{"r.in reads topic '/nowhere', which nobody writes"});
}

}  // namespace
}  // namespace armature
