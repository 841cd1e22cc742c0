// SPDX-License-Identifier: Apache-2.0
// A small deployment: camera -> task -> motion -> arm, where the arm moves something. A monitor
// reads from all, a report measures, a recorder reads what the monitor writes.
#include "armature/runtime/deployment_file/on_fault.hpp"

#include <gtest/gtest.h>

namespace armature {
namespace {

class OnFaultTest : public testing::Test {
 protected:
  OnFaultTest() {
    arm_.driver.emplace();
    report_.measures.push_back({.name = "error_mm"});
    add("camera", plain_, {}, {"image"});
    add("task", plain_, {"image"}, {"goal"});
    add("motion", plain_, {"goal", "measured"}, {"command"});
    add("arm", arm_, {"command"}, {"measured"});
    component("arm").inputs.front().spec.qos = QosProfile::command;
    add("monitor", plain_, {"image", "goal", "measured"}, {"markers"});
    add("recorder", plain_, {"markers"}, {});
    add("report", report_, {"measured"}, {});
  }

  void add(const char* name, const PluginManifest& manifest, const std::vector<const char*>& inputs,
           const std::vector<const char*>& outputs) {
    ComponentConfig component{.name = name, .manifest = &manifest, .executor = "main"};
    for (const char* topic : inputs) component.inputs.push_back({.topic = topic});
    for (const char* topic : outputs) component.outputs.push_back({.topic = topic});
    deployment_.components.push_back(std::move(component));
  }
  ComponentConfig& component(const std::string& name) {
    return *std::ranges::find(deployment_.components, name, &ComponentConfig::name);
  }
  std::string isolated() {
    decide_on_faults(deployment_);
    std::string names;
    for (const ComponentConfig& one : deployment_.components) {
      if (!stops_run(one)) names += one.name + " ";
    }
    return names;
  }

  std::string refusals() {
    config::Problems problems;
    check_isolation(deployment_, problems);
    std::string text;
    for (const auto& problem : problems.sorted()) text += problem.message + "\n";
    return text;
  }

  PluginManifest plain_, arm_, report_;
  DeploymentConfig deployment_;
};

TEST_F(OnFaultTest, WhatLeadsToADriverOrMeasuresStopsTheRunAndTheRestIsIsolated) {
  EXPECT_EQ(isolated(), "monitor recorder ");
}

TEST_F(OnFaultTest, WithoutADriverEverythingStopsTheRun) {
  arm_.driver.reset();
  EXPECT_EQ(isolated(), "");
}

TEST_F(OnFaultTest, WhatTheMonitorWritesIsOnTheWayOnceTheTaskReadsIt) {
  component("task").inputs.push_back({.topic = "markers"});
  EXPECT_EQ(isolated(), "recorder ");
}

TEST_F(OnFaultTest, WhatTheFileSaysHolds) {
  component("camera").on_fault = OnFault::isolate;
  component("monitor").on_fault = OnFault::stop;
  EXPECT_EQ(isolated(), "camera recorder ");
}

TEST_F(OnFaultTest, WhatMovesAnArmOrCommandsItIsNotIsolated) {
  EXPECT_EQ(refusals(), "");
  for (const char* name : {"camera", "task", "motion", "arm", "monitor"}) {
    component(name).on_fault = OnFault::isolate;
  }
  EXPECT_EQ(refusals(),
            "component 'motion' commands what moves an arm, and 'on_fault: isolate' would let the "
            "run go on when it fails; leave 'on_fault' out, and its fault stops the run\n"
            "component 'arm' moves an arm, and 'on_fault: isolate' would let the run go on when it "
            "fails; leave 'on_fault' out, and its fault stops the run\n");
}

TEST_F(OnFaultTest, WhatLeadsToAnArmAndIsIsolatedIsTold) {
  component("camera").on_fault = component("monitor").on_fault = OnFault::isolate;
  EXPECT_EQ(isolation_warnings(deployment_),
            std::vector<std::string>{
                "component 'camera' leads to what moves an arm, and is isolated: when it fails, "
                "the run goes on without it; leave 'on_fault' out, and its fault stops the run"});
}

TEST_F(OnFaultTest, TheLossOfAProcessStopsTheRunWhenAFaultOfOneOfItsComponentsDoes) {
  for (ComponentConfig& one : deployment_.components) one.process = "main";
  component("monitor").process = component("recorder").process = "aside";
  decide_on_faults(deployment_);
  // The runtime adds it to every process once that is constructed.
  add("runtime", plain_, {}, {});
  deployment_.components.back().process = "aside";
  EXPECT_FALSE(stops_run("aside", deployment_));
  EXPECT_TRUE(stops_run("main", deployment_));
  component("camera").process = "aside";
  EXPECT_TRUE(stops_run("aside", deployment_));
}

TEST_F(OnFaultTest, WhoSharesTheDriversExecutorWithoutNeedIsTold) {
  EXPECT_EQ(executor_warnings(deployment_),
            std::vector<std::string>{
                "component 'arm' moves an arm and shares the executor 'main' with camera, task, "
                "monitor, recorder, report: when a step of theirs is long or hangs, the arm waits; "
                "name another executor for them"});
  deployment_.executors.push_back({.name = "control", .period = seconds(0.001)});
  for (const char* name : {"task", "motion", "arm"}) component(name).executor = "control";
  EXPECT_TRUE(executor_warnings(deployment_).empty()) << "what leads there may keep its pace";
  add("other_arm", arm_, {}, {});
  component("other_arm").executor = "control";
  EXPECT_TRUE(executor_warnings(deployment_).empty()) << "two arms may share their pace";
  deployment_.components.pop_back();
  component("monitor").executor = "control";
  ASSERT_EQ(executor_warnings(deployment_).size(), 1U);
  EXPECT_NE(executor_warnings(deployment_)[0].find("'control' with monitor: "), std::string::npos);
  component("monitor").process = "elsewhere";
  EXPECT_TRUE(executor_warnings(deployment_).empty());
}

}  // namespace
}  // namespace armature
