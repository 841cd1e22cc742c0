// SPDX-License-Identifier: Apache-2.0
// A newcomer's plugin: written by `armature plugin new`, built outside this tree, and used.
#include <gtest/gtest.h>
#include <unistd.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <iterator>

#include "command.hpp"

namespace armature::test {
namespace {

namespace fs = std::filesystem;

class NewPlugin : public testing::Test {
 protected:
  NewPlugin() { fs::remove_all(folder); }
  ~NewPlugin() override { fs::remove_all(folder); }

  CommandResult write(const std::string& id) const {
    return run_command({armature(), "plugin", "new", id, "-o", folder});
  }
  void expect_ok(const std::vector<std::string>& command) const {
    const auto result = run_command(command, {}, std::chrono::seconds{120});
    EXPECT_EQ(result.exit_code, 0) << command[0] << ": " << result.out << result.err;
  }

  const fs::path folder = fs::temp_directory_path() / ("armature-new-" + std::to_string(getpid()));
};

TEST_F(NewPlugin, BuildsOutsideTheTreePassesItsTestAndSolvesForTheLamp) {
  ASSERT_EQ(write("ik/mine").exit_code, 0);
  const std::string build = folder / "build";
  expect_ok({CMAKE_PROGRAM, "-S", folder, "-B", build, "-DCMAKE_BUILD_TYPE=Release"});
  expect_ok({CMAKE_PROGRAM, "--build", build});
  expect_ok({CTEST_PROGRAM, "--test-dir", build, "--no-tests=error", "--output-on-failure"});

  const Command::Options with_it{
      .environment = {{"ARMATURE_PLUGIN_PATH", build}},
      .input = R"({"position_m":[1.05,0,0.45],"direction":[1,0,0],"seed":[1.2,-2,0,0,0.8,0]})"};
  const auto info = run_command({armature(), "plugin", "info", "ik/mine"}, with_it);
  EXPECT_NE(info.out.find("damping"), std::string::npos) << info.err;
  const auto answer =
      run_command({armature(), "ik", "--robot", source_file("configs/robots/dental_lamp.yaml"),
                   "--plugin", "ik/mine"},
                  with_it);
  EXPECT_EQ(answer.out.rfind("{\"status\":\"ok\"", 0), 0U) << answer.out << answer.err;
  const auto check = run_command({armature(), "check", source_file("configs/dental_lamp.yaml"),
                                  "--set", "components.motion.ik.plugin=ik/mine"},
                                 with_it);
  EXPECT_EQ(check.exit_code, 0) << check.err;
  const auto verify = run_command({armature(), "plugin", "verify", "ik/mine", "--robot",
                                   folder / "arm.urdf", "--tip", "tool0", "--poses", "50"},
                                  with_it);
  EXPECT_EQ(verify.exit_code, 0) << verify.out << verify.err;
}

TEST_F(NewPlugin, OfAPathBuildsKeepsItsLawsAndMovesTheLamp) {
  ASSERT_EQ(write("path/mine").exit_code, 0);
  const std::string build = folder / "build";
  expect_ok({CMAKE_PROGRAM, "-S", folder, "-B", build, "-DCMAKE_BUILD_TYPE=Release"});
  expect_ok({CMAKE_PROGRAM, "--build", build});
  expect_ok({CTEST_PROGRAM, "--test-dir", build, "--no-tests=error", "--output-on-failure"});
  const auto check = run_command(
      {armature(), "check", "dental_lamp", "--set", "components.motion.path.plugin=path/mine"},
      {.environment = {{"ARMATURE_PLUGIN_PATH", build}}, .input = {}});
  EXPECT_EQ(check.exit_code, 0) << check.err;
}

TEST_F(NewPlugin, OfAMonitorBuildsKeepsItsLawsAndWatchesTheLamp) {
  ASSERT_EQ(write("monitor/mine").exit_code, 0);
  const std::string build = folder / "build";
  expect_ok({CMAKE_PROGRAM, "-S", folder, "-B", build, "-DCMAKE_BUILD_TYPE=Release"});
  expect_ok({CMAKE_PROGRAM, "--build", build});
  expect_ok({CTEST_PROGRAM, "--test-dir", build, "--no-tests=error", "--output-on-failure"});
  const auto run = run_command({armature(), "run", "dental_lamp", folder / "overlay.yaml", "--set",
                                "clock=simulated", "--json"},
                               {.environment = {{"ARMATURE_PLUGIN_PATH", build}}, .input = {}},
                               std::chrono::seconds{120});
  EXPECT_EQ(run.exit_code, 0) << run.err;
  EXPECT_NE(run.out.find("greatest_speed_rad_s"), std::string::npos) << run.out;
}

TEST_F(NewPlugin, IsAShortSolverAndThreeLinesOfCMakeBesidesItsVersion) {
  ASSERT_EQ(write("ik/mine").exit_code, 0);
  const auto lines_of = [&](const char* file) {
    std::ifstream in{folder / file};
    return std::count(std::istreambuf_iterator<char>{in}, {}, '\n');
  };
  EXPECT_LE(lines_of("mine.cpp"), 41);
  EXPECT_EQ(lines_of("CMakeLists.txt"), 4);
}

TEST_F(NewPlugin, OfAnArmComesWithADeploymentThatIsSoundButForTheArmItself) {
  ASSERT_EQ(write("arm/mine").exit_code, 0);
  const auto check_with = [&](const char* path) {
    const auto check = run_command({armature(), "check", folder / "tour.yaml"},
                                   {.environment = {{"ARMATURE_PLUGIN_PATH", path}}, .input = {}});
    EXPECT_EQ(check.exit_code, 3);
    EXPECT_NE(check.err.find("unknown plugin 'arm/mine'"), std::string::npos) << check.err;
    return check.err;
  };
  EXPECT_NE(check_with("").find("; ARMATURE_PLUGIN_PATH adds folders of your own"),
            std::string::npos);
  EXPECT_NE(check_with("/gone").find("; searched /gone (no such folder), "), std::string::npos);
  const auto other = run_command(
      {armature(), "check", folder / "tour.yaml", "--set", "components.arm.plugin=arm/simulated"});
  EXPECT_EQ(other.exit_code, 0) << other.err;
}

TEST_F(NewPlugin, RefusesANameThatIsNoName) {
  const auto result = write("ik/My Solver");
  EXPECT_EQ(result.exit_code, 3);
  EXPECT_EQ(result.err,
            "armature: 'ik/My Solver' must be 'arm/name', 'ik/name', 'monitor/name', 'path/name', "
            "the name "
            "in lower case letters, digits and '_'\n");
}

TEST_F(NewPlugin, RefusesAnIdThatIsTakenAndTellsByWhat) {
  const auto result = write("ik/kdl");
  EXPECT_EQ(result.exit_code, 3);
  EXPECT_TRUE(result.err.starts_with("armature: there is a plugin 'ik/kdl' already, '"))
      << result.err;
  EXPECT_TRUE(result.err.ends_with("/ik_kdl.so'; choose another name\n")) << result.err;
  EXPECT_FALSE(fs::exists(folder));
}

TEST_F(NewPlugin, OfAFamilyWithoutATemplateNamesThoseThatHaveOne) {
  const auto result = write("target/mine");
  EXPECT_EQ(result.exit_code, 3);
  EXPECT_EQ(result.err,
            "armature: there is no template for 'target/...', only for 'arm/...', 'ik/...', "
            "'monitor/...', 'path/...'; begin with a copy of such a plugin, see plugins/ in the "
            "sources\n");
  EXPECT_FALSE(fs::exists(folder));
}

TEST_F(NewPlugin, SaysWhyItsFolderCannotBeMade) {
  const auto result = run_command({armature(), "plugin", "new", "ik/mine", "-o", "/dev/null/mine"});
  EXPECT_EQ(result.exit_code, 1);
  EXPECT_EQ(result.err, "armature: cannot make the folder '/dev/null/mine': Not a directory\n");
}

TEST_F(NewPlugin, RefusesAFolderThatIsNotEmpty) {
  ASSERT_EQ(write("ik/mine").exit_code, 0);
  const auto result = write("ik/mine");
  EXPECT_EQ(result.exit_code, 3);
  EXPECT_NE(result.err.find("is there already and not empty"), std::string::npos);
}

}  // namespace
}  // namespace armature::test
