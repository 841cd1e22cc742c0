// SPDX-License-Identifier: Apache-2.0
#include "run/joint_reports.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <map>
#include <string>
#include <vector>

#include "armature/config/document.hpp"
#include "armature/runtime/deployment_file/on_fault.hpp"
#include "armature/runtime/testing/test_plugins.hpp"

namespace armature {
namespace {

DeploymentConfig deployment(const std::string& file,
                            const std::vector<std::string>& settings = {}) {
  config::Problems problems;
  DeploymentConfig read = read_deployment(
      config::load_with_overlays({ARMATURE_SOURCE_DIR "/configs/" + file}, settings),
      built_plugins(), problems);
  problems.throw_if_any();
  return read;
}

const ComponentConfig& component(const DeploymentConfig& deployment, const std::string& name) {
  const auto found = std::ranges::find(deployment.components, name, &ComponentConfig::name);
  if (found == deployment.components.end()) throw std::runtime_error("no component " + name);
  return *found;
}

std::map<std::string, std::string> topics_of(const ComponentConfig& component) {
  std::map<std::string, std::string> topics;
  for (const PortBinding& input : component.inputs) topics[input.spec.name] = input.topic;
  return topics;
}

TEST(JointReports, EachOfTwoArmsHasOneThatReadsItsOwnTopics) {
  DeploymentConfig teleoperation = deployment("master_manipulator.yaml");
  add_joint_reports(teleoperation, built_plugins(), "/reports");
  const ComponentConfig& leader = component(teleoperation, "leader.joints");
  const ComponentConfig& follower = component(teleoperation, "arm.joints");
  const std::string space = "/master_manipulator/";
  EXPECT_EQ(topics_of(leader),
            (std::map<std::string, std::string>{{"measured_js", space + "leader/arm/measured_js"},
                                                {"servo_jp", space + "leader/arm/servo_jp"},
                                                {"goal", space + "leader/motion/goal"},
                                                {"status", space + "leader/motion/status"}}));
  EXPECT_EQ(topics_of(follower),
            (std::map<std::string, std::string>{{"measured_js", space + "arm/measured_js"},
                                                {"servo_jp", space + "arm/servo_jp"},
                                                {"goal", space + "motion/goal"},
                                                {"status", space + "motion/status"}}));
  EXPECT_EQ(leader.documents.at("robots"), "leader");
  EXPECT_EQ(follower.documents.at("robots"), "follower");
  EXPECT_EQ(follower.params.text("file"), "/reports/arm_joints");
}

TEST(JointReports, ItIsAloneOnItsThreadComesLastAndItsFaultStaysWhereItIs) {
  DeploymentConfig lamp = deployment("dental_lamp.yaml");
  const DeploymentConfig before = lamp;
  add_joint_reports(lamp, built_plugins(), "/reports");
  const ComponentConfig& report = component(lamp, "arm.joints");
  EXPECT_FALSE(stops_run(report));
  EXPECT_EQ(std::ranges::count(lamp.components, report.executor, &ComponentConfig::executor), 1);
  EXPECT_EQ(std::ranges::count(lamp.executors, report.executor, &ExecutorSpec::name), 1);
  for (const ComponentConfig& other : before.components) EXPECT_LT(other.place, report.place);
  EXPECT_EQ(lamp.fingerprint, before.fingerprint) << "other processes read the file as it is";
}

TEST(JointReports, AnArmInAnotherProcessIsReportedByTheMainOne) {
  DeploymentConfig lamp = deployment("dental_lamp.yaml", {"components.arm.process=arm"});
  add_joint_reports(lamp, built_plugins(), "/reports");
  EXPECT_EQ(component(lamp, "arm.joints").process, kMainProcess);
}

TEST(JointReports, ADeploymentWithoutAnArmHasNone) {
  DeploymentConfig solvers;
  add_joint_reports(solvers, built_plugins(), "/reports");
  EXPECT_TRUE(solvers.components.empty());
}

TEST(JointReports, NoNameOfAnArmLeadsOutOfTheFolder) {
  DeploymentConfig lamp = deployment("dental_lamp.yaml");
  std::ranges::find(lamp.components, "arm", &ComponentConfig::name)->name = "../left arm";
  add_joint_reports(lamp, built_plugins(), "/reports");
  EXPECT_EQ(component(lamp, "../left arm.joints").params.text("file"),
            "/reports/.._left_arm_joints");
}

}  // namespace
}  // namespace armature
