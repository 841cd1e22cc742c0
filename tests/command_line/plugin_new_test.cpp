// SPDX-License-Identifier: Apache-2.0
// What `armature plugin new` writes and refuses. That it builds and runs: new_plugins_test.cpp.
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>

#include "armature/values/file_content.hpp"
#include "armature/values/temporary_folder.hpp"
#include "command.hpp"

namespace armature::test {
namespace {

namespace fs = std::filesystem;

class NewPlugin : public testing::Test {
 protected:
  CommandResult write(const std::string& id) const {
    return run_command({armature(), "plugin", "new", id, "-o", folder});
  }
  const TemporaryFolder above;
  const fs::path folder = above / "new";
};

TEST_F(NewPlugin, IsAShortSolverAndThreeLinesOfCMakeBesidesItsVersion) {
  ASSERT_EQ(write("ik/mine").exit_code, 0);
  const auto lines_of = [&](const char* file) {
    return std::ranges::count(content_of(folder / file), '\n');
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
  EXPECT_EQ(
      result.err,
      "armature: 'ik/My Solver' must be 'family/name', the name in lower case letters, digits "
      "and '_'; `armature plugin new --help` lists the families\n");
}

TEST_F(NewPlugin, ItsClassIsNotCalledAsAnotherOfItsFile) {
  const auto class_of = [&](const std::string& id) {
    fs::remove_all(folder);
    EXPECT_EQ(write(id).exit_code, 0);
    const std::string text = content_of(folder / (id.substr(id.find('/') + 1) + ".cpp"));
    const auto at = text.find("class ");
    return text.substr(at, text.find(' ', at + 6) - at);
  };
  EXPECT_EQ(class_of("path/mine"), "class Mine");
  EXPECT_EQ(class_of("path/path"), "class PathPlugin");
  EXPECT_EQ(class_of("trajectory/trajectory"), "class TrajectoryPlugin");
  EXPECT_EQ(class_of("ik/params"), "class ParamsPlugin");
}

TEST_F(NewPlugin, ANameThatCppHasTakenIsANamespaceWithAnUnderscore) {
  ASSERT_EQ(write("ik/class").exit_code, 0);
  const std::string text = content_of(folder / "class.cpp");
  EXPECT_NE(text.find("namespace armature::ik::class_ {"), std::string::npos) << text;
}

TEST_F(NewPlugin, RefusesAnIdThatIsTakenAndTellsByWhat) {
  const auto result = write("ik/kdl");
  EXPECT_EQ(result.exit_code, 3);
  EXPECT_TRUE(result.err.starts_with("armature: there is a plugin 'ik/kdl' already, '"))
      << result.err;
  EXPECT_TRUE(result.err.ends_with("/ik_kdl.so'; choose another name\n")) << result.err;
  EXPECT_FALSE(fs::exists(folder));
}

TEST_F(NewPlugin, OfAFamilyThatThereIsNotNamesTheNearest) {
  const auto result = write("targt/mine");
  EXPECT_EQ(result.exit_code, 3);
  EXPECT_EQ(result.err,
            "armature: there is no family of plugins 'targt'; did you mean 'target'?; `armature "
            "plugin new --help` lists all\n");
  EXPECT_FALSE(fs::exists(folder));
}

TEST_F(NewPlugin, LeavesNoMarkOfItsTemplateInAnyFamily) {
  for (const char* family : {"arm", "camera", "detector", "ik", "monitor", "task"}) {
    fs::remove_all(folder);
    ASSERT_EQ(write(std::string{family} + "/mine").exit_code, 0);
    for (const auto& entry : fs::directory_iterator{folder}) {
      const std::string text = content_of(entry.path());
      EXPECT_EQ(text.find('@'), std::string::npos) << entry.path();
      EXPECT_EQ(entry.path().filename().string().find('@'), std::string::npos) << entry.path();
    }
  }
}

TEST_F(NewPlugin, HelpHasALineForEachFamily) {
  const std::string help = run_command({armature(), "plugin", "new", "--help"}).out;
  for (const char* line :
       {"  camera/...    the driver of a camera, or of any device whose calls wait\n",
        "  ik/...        inverse kinematics: every joint position for a pose of the tool\n",
        "  task/...      what the arm shall do: gives goals, and ends the run\n"}) {
    EXPECT_NE(help.find(line), std::string::npos) << help;
  }
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
