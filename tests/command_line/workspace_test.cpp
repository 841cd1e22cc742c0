// SPDX-License-Identifier: Apache-2.0
// `armature workspace`: 1. its figures, its CSV and its picture, free and about an incision, 2.
// what it cannot compute, in words.
#include <gtest/gtest.h>

#include <algorithm>
#include <nlohmann/json.hpp>

#include "armature/values/temporary_folder.hpp"
#include "tests/command.hpp"
#include "tests/text.hpp"

namespace armature::test {
namespace {

using nlohmann::json;

const std::string kScope = source_file("configs/robots/med7_scope.yaml");

CommandResult workspace(std::vector<std::string> arguments, const std::string& robot = kScope) {
  arguments.insert(arguments.begin(), {armature(), "workspace", "--robot", robot});
  return run_command(arguments);
}

TEST(WorkspaceCommand, OfAnIncisionIsPartOfTheFreeOne) {
  const json free = json::parse(workspace({"--samples", "20000", "--json"}).out);
  const json about = json::parse(workspace({"--incision", "0.511533,-0.06343,0.267141", "--plugin",
                                            "ik/srs_arm_angle", "--samples", "2000", "--json"})
                                     .out);
  EXPECT_EQ(free["reached"], 20000);
  EXPECT_GT(about["reached"], 0);
  EXPECT_LT(about["reached"], 2000);
  EXPECT_GT(about["volume_litres"], 0);
  for (const char* axis : {"x_m", "y_m", "z_m"}) {
    EXPECT_LT(free[axis][0], about[axis][0]);
    EXPECT_GT(free[axis][1], about[axis][1]);
  }
}

TEST(WorkspaceCommand, WritesEveryPointWithItsJointsAndAPicture) {
  const TemporaryFolder folder;
  const CommandResult result = workspace({"--samples", "300", "--out", folder / "out"},
                                         source_file("configs/robots/master.yaml"));
  EXPECT_EQ(result.exit_code, 0) << result.err;
  const std::string csv = text_of(folder / "out/workspace.csv");
  EXPECT_EQ(csv.substr(0, csv.find('\n')), "x_m,y_m,z_m,j1,j2,j3,j4,j5,j6");
  EXPECT_EQ(std::ranges::count(csv, '\n'), 301);
  EXPECT_NE(text_of(folder / "out/workspace.svg").find("Workspace of the tip of master"),
            std::string::npos);
}

TEST(WorkspaceCommand, OfASinglePointIsDrawnWhereItIs) {
  const TemporaryFolder folder;
  const CommandResult result = workspace({"--samples", "1", "--out", folder / "out"},
                                         source_file("configs/robots/master.yaml"));
  EXPECT_EQ(result.exit_code, 0) << result.err;
  const std::string svg = text_of(folder / "out/workspace.svg");
  EXPECT_EQ(svg.find("nan"), std::string::npos);
  EXPECT_EQ(svg.find("inf"), std::string::npos);
}

TEST(WorkspaceCommand, IsThatOfAnArmWhoseJointsTurnWithoutAnEnd) {
  const CommandResult result = workspace({"--tip", "gripper", "--samples", "100", "--json"},
                                         source_file("tests/data/urdf/gantry.urdf"));
  EXPECT_EQ(result.exit_code, 0) << result.err;
  EXPECT_EQ(json::parse(result.out)["reached"], 100);
}

TEST(WorkspaceCommand, WhatCannotBeComputedIsSaid) {
  const auto expect_said = [](const CommandResult& result, int exit_code, const std::string& what) {
    EXPECT_EQ(result.exit_code, exit_code);
    EXPECT_NE(result.err.find(what), std::string::npos) << result.err;
  };
  expect_said(workspace({"--incision", "0,0,1"}, source_file("configs/robots/med7.yaml")), 3,
              "robot 'med7' names no shaft to go through an incision");
  expect_said(workspace({"--incision", "0,nan,1"}), 3, "--incision (0, nan, 1) is not finite");
  expect_said(workspace({"--incision", "0,0,1", "--min-depth", "300"}), 3,
              "--min-depth is 300 mm, not between 0 and the 280 mm of the shaft");
  expect_said(workspace({"--incision", "0,1"}), 2, "--incision");
  expect_said(workspace({"--seed", "-1"}), 2, "--seed");
  const CommandResult early = workspace({"--samples", "300", "--out", kScope + "/below_a_file"});
  expect_said(early, 1, "/below_a_file'");
  EXPECT_EQ(early.out, "") << "it is tried before what takes long";
  expect_said(workspace({"--incision", "3,0,1", "--samples", "20"}), 1,
              "the tip comes nowhere; is the incision within the arm's reach?");
}

}  // namespace
}  // namespace armature::test
