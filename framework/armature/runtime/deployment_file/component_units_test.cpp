// SPDX-License-Identifier: Apache-2.0
// A component that is several units: who has which ports and slots, and what a plugin.yaml that
// says it wrongly is told.
#include "armature/runtime/deployment_file/component_units.hpp"

#include <gtest/gtest.h>

#include "tests/refusal.hpp"

namespace armature {
namespace {

constexpr const char* kTwoUnits =
    "armature_plugin: 1\nid: mine\nkind: component\n"
    "units: {planner: {doc: Takes its time}}\n"
    "slots:\n"
    "  path: {kind: path, units: [planner]}\n"
    "  ik: {kind: ik, units: [main, planner]}\n"
    "in:\n"
    "  goal: {type: std_msgs/Bool, units: [main, planner]}\n"
    "  state: {type: std_msgs/Bool}\n"
    "out:\n"
    "  plan: {type: std_msgs/Bool, units: [planner]}\n";

PluginManifest manifest_of(const std::string& yaml) {
  config::Problems problems;
  auto manifest = parse_manifest(yaml, "plugin.yaml", problems);
  problems.throw_if_any();
  return manifest;
}

ComponentConfig entry(const PluginManifest& manifest) {
  ComponentConfig component;
  component.name = "arm";
  component.manifest = &manifest;
  component.executor = "control";
  component.sim_latency = seconds(1);
  for (const SlotSpec& slot : manifest.slots) component.slots.push_back({.name = slot.name});
  for (const PortSpec& port : manifest.inputs) component.inputs.push_back({.spec = port});
  for (const PortSpec& port : manifest.outputs) component.outputs.push_back({.spec = port});
  return component;
}

/// "arm.planner on arm.planner: path ik goal plan"
std::string text_of(const ComponentConfig& unit) {
  std::string text = unit.name + " on " + unit.executor + ":";
  for (const auto& slot : unit.slots) text += " " + slot.name;
  for (const auto& port : unit.inputs) text += " " + port.spec.name;
  for (const auto& port : unit.outputs) text += " " + port.spec.name;
  return text;
}

TEST(ComponentUnits, EachHasItsOwnPortsAndSlotsAndAThread) {
  const PluginManifest manifest = manifest_of(kTwoUnits);
  const auto units = units_of(entry(manifest));
  ASSERT_EQ(units.size(), 2u);
  EXPECT_EQ(text_of(units[0]), "arm on control: ik goal state");
  EXPECT_EQ(text_of(units[1]), "arm.planner on arm.planner: path ik goal plan");
  EXPECT_EQ(units[1].unit, "planner");
  EXPECT_EQ(units[0].sim_latency, seconds(1));
  EXPECT_EQ(units[1].sim_latency, Duration{0}) << "it says its own";
}

TEST(ComponentUnits, AThreadThatTheFileDescribesIsNotMadeAgain) {
  const PluginManifest manifest = manifest_of(kTwoUnits);
  DeploymentConfig deployment;
  deployment.components = units_of(entry(manifest));
  deployment.executors = {{.name = "control"}};
  add_unit_executors(deployment);
  add_unit_executors(deployment);
  ASSERT_EQ(deployment.executors.size(), 2u);
  EXPECT_EQ(deployment.executors[1].name, "arm.planner");
}

TEST(ComponentUnits, AUnitThatIsNotThereIsAProblem) {
  EXPECT_EQ(test::refusal_of([&] {
              manifest_of(
                  "armature_plugin: 1\nid: mine\nkind: component\nunits: {planner: {}}\n"
                  "in: {goal: {type: std_msgs/Bool, units: [planer]}}\n");
            }),
            "plugin.yaml:5:41: 'planer' is no unit of the component; did you mean 'planner'?");
}

}  // namespace
}  // namespace armature
