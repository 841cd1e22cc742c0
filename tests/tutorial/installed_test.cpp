// SPDX-License-Identifier: Apache-2.0
// An installed Armature needs nothing of the folder that it was built in: a new plugin's README
// holds for it, too.
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <string>
#include <vector>

#include "armature/values/temporary_folder.hpp"
#include "command.hpp"
#include "page.hpp"
#include "tests/dds_domain.hpp"
#include "tests/text.hpp"

namespace armature::test {
namespace {

namespace fs = std::filesystem;

/// The indented lines of a README, each shown before it is run, by a shell that ends with the first
/// that fails.
std::string script_of(const std::string& readme) {
  std::istringstream lines{readme};
  std::string script = "set -e\n";
  for (std::string line; std::getline(lines, line);) {
    if (!line.starts_with("    ")) continue;
    script += "echo '$" + line.substr(3) + "'\n" + line + "\n";
  }
  return script;
}

/// Installed into a folder of its own.
class Installed : public testing::Test {
 protected:
  void SetUp() override {
    const auto result =
        run_command({CMAKE_PROGRAM, "--install", ARMATURE_BINARY_DIR, "--prefix", prefix_});
    ASSERT_EQ(result.exit_code, 0) << result.err;
  }
  CommandResult shell(const std::string& script) const {
    const Command::Options environment{
        .environment = {{"PATH", (prefix_ / "bin").string() + ":" + std::getenv("PATH")},
                        {"ARMATURE_PLUGIN_PATH", ""}},
        .input = {}};
    return run_command({"/bin/bash", "-c", "cd " + folder_.path().string() + "\n" + script},
                       environment, std::chrono::seconds{200});
  }

  const TemporaryFolder folder_;
  const fs::path prefix_ = folder_ / "prefix";
};

TEST_F(Installed, ANewPluginIsBuiltTestedVerifiedMeasuredAndDeployedAsItsReadmeSays) {
  const auto written = shell("armature plugin new ik/mine -o mine");
  ASSERT_EQ(written.exit_code, 0) << written.err;
  EXPECT_NE(text_of(folder_ / "mine/CMakeLists.txt").find(prefix_.string()), std::string::npos);
  const std::string readme =
      all_replaced(text_of(folder_ / "mine/README.md"), "--poses 10000", "--poses 200");
  const auto result = shell("cd mine\n" + script_of(readme));
  EXPECT_EQ(result.exit_code, 0) << result.out << result.err;
  for (const char* shown : {"100% tests passed", "loading leaves nothing behind", "times ik/kdl",
                            "SHA-256 of the arm's trajectory"}) {
    EXPECT_NE(result.out.find(shown), std::string::npos) << shown << "\n" << result.out;
  }
}

TEST_F(Installed, TheLibraryPageBuildsAndRuns) {
  const std::string page = text_of(ARMATURE_SOURCE_DIR "/docs/library.md");
  std::ofstream{folder_ / "CMakeLists.txt"} << block_of(page, "cmake");
  std::ofstream{folder_ / "reach.cpp"} << block_of(page, "cpp");
  const auto result = shell("set -e\ncmake -S . -B build -DCMAKE_PREFIX_PATH=" + prefix_.string() +
                            " > cmake.log\ncmake --build build > build.log\nbuild/reach " +
                            prefix_.string() + "/share/armature/configs/robots/dental_lamp.yaml");
  EXPECT_EQ(result.exit_code, 0) << text_of(folder_ / "build.log") << result.err;
  EXPECT_TRUE(result.out.starts_with("ok\n")) << result.out;
  EXPECT_EQ(std::count(result.out.begin(), result.out.end(), '\n'), 2) << result.out;
  const std::string robots = prefix_.string() + "/share/armature/configs/robots/";
  const auto without_home = shell("build/reach " + robots + "sr1.yaml");
  EXPECT_TRUE(without_home.out.starts_with("ok\n")) << without_home.out << without_home.err;
  const auto no_robot_file =
      shell("build/reach " ARMATURE_SOURCE_DIR "/tests/data/urdf/gantry.urdf");
  EXPECT_EQ(no_robot_file.exit_code, 1);
  EXPECT_NE(no_robot_file.err.find("an XML file, not YAML"), std::string::npos)
      << no_robot_file.err;
  const auto nothing = shell("build/reach");
  EXPECT_EQ(nothing.exit_code, 2);
  EXPECT_EQ(nothing.err, "usage: reach ROBOT.yaml\n");
}

/// Writes the blocks of a page that follow a line "`FILE`:" into files below `folder`. What its
/// "$ ..." lines say, in order.
std::vector<std::string> write_files(const std::string& page, const fs::path& folder) {
  std::vector<std::string> commands;
  std::istringstream lines{page};
  std::string name, block;
  std::ofstream file;
  for (std::string line; std::getline(lines, line);) {
    if (line.starts_with("```")) {
      block = block.empty() ? line : "";
      file.close();
      if (block.empty() || name.empty()) continue;
      fs::create_directories((folder / name).parent_path());
      file.open(folder / name);
      name.clear();
    } else if (file.is_open()) {
      file << line << '\n';
    } else if (block == "```console" && line.starts_with("$ ")) {
      commands.push_back(line.substr(2));
    } else if (line.starts_with('`') && line.ends_with("`:")) {
      name = line.substr(1, line.size() - 3);
    }
  }
  return commands;
}

TEST_F(Installed, TheMessagesPageBuildsAndRuns) {
  const auto commands =
      write_files(text_of(ARMATURE_SOURCE_DIR "/docs/your_own_messages.md"), folder_.path());
  EXPECT_EQ(commands.size(), 8U);
  std::string script = "set -e\nexport PREFIX=" + prefix_.string() + "\n";
  // A reader is alone on his machine; tests are not. In the background the program takes the place
  // of the shell, whose number `kill $!` has.
  script += "armature() { local more=; case $1 in run|topic) more='--domain " +
            std::to_string(unique_dds_domain()) +
            "';; esac; [ $BASHPID = $$ ] || exec armature \"$@\" $more; command armature \"$@\" "
            "$more; }\n";
  for (const std::string& command : commands) script += command + "\n";
  const auto result = shell(script);
  EXPECT_EQ(result.exit_code, 0) << result.out << result.err;
  for (const char* shown :
       {"100% tests passed", "/weather/report", "weather_msgs/Report", "\"frame_id\": \"roof\"",
        "\"wind\": 12.5", "\"readings\": [{\"sensor\": \"vane\", \"value\": 0.25}]"}) {
    EXPECT_NE(result.out.find(shown), std::string::npos) << shown << "\n" << result.out;
  }
  EXPECT_NE(result.err.find("strong wind"), std::string::npos) << result.err;

  const std::string in_path = "export ARMATURE_PLUGIN_PATH=$PWD/weather/build/plugins\n";
  const auto listed = shell(in_path + "armature plugin list --json");
  EXPECT_EQ(listed.out.find("libweather_msgs"), std::string::npos) << listed.out;

  // A plugin that was built for other members than its library has now.
  const auto stale =
      shell(in_path +
            "sed -i 's/octet sky_;/octet sky_; octet clouds_;/' weather/weather_msgs.idl\n"
            "cmake --build weather/build --target weather_msgs > stale.log &&"
            "armature plugin verify weather/alarm");
  EXPECT_NE(stale.exit_code, 0);
  EXPECT_NE(stale.out.find("it was built for other members of this message: build it again"),
            std::string::npos)
      << stale.out << stale.err;
}

TEST_F(Installed, TheExamplesOfMonitorsBuildAndSeeARunningDeployment) {
  for (const std::string example : {"monitor_cyclone", "monitor_fast_dds"}) {
    const std::string domain = std::to_string(unique_dds_domain());
    const auto result =
        shell("set -e\ncp -r " ARMATURE_SOURCE_DIR "/apps/examples/" + example + " .\ncd " +
              example + "\n(cmake -B build -DCMAKE_PREFIX_PATH=" + prefix_.string() +
              " && cmake --build build) > build.log || { cat build.log; exit 1; }\n"
              "armature run dental_lamp --keep-running --domain " +
              domain +
              " > run.log 2>&1 & run=$!\n"
              "timeout -s INT 15 build/" +
              example + " dental_lamp " + domain +
              " | tee seen.log | "
              "grep -q 'main/landmarks: ok, 99 of 100' || true\ncat seen.log\nkill -INT $run\nwait "
              "$run || true");
    EXPECT_EQ(result.exit_code, 0) << result.out << result.err;
    for (const char* shown :
         {"dental_lamp: process main of Armature ", "  landmarks (landmarks/dlib68)\n",
          "    -> /dental_lamp/arm/measured_js [sensor_msgs/JointState]\n",
          "main/arm: ok, 99 of 100"}) {
      EXPECT_NE(result.out.find(shown), std::string::npos) << example << ": " << shown << "\n"
                                                           << result.out;
    }
  }
}

TEST_F(Installed, AComponentThatThereIsNotIsNamed) {
  std::ofstream{folder_ / "CMakeLists.txt"}
      << "cmake_minimum_required(VERSION 3.20)\nproject(none CXX)\n"
         "find_package(Armature REQUIRED COMPONENTS robot teleport)\n";
  const auto result = shell("cmake -S . -B build -DCMAKE_PREFIX_PATH=" + prefix_.string());
  EXPECT_NE(result.exit_code, 0);
  EXPECT_NE(result.err.find("there is no library Armature::teleport"), std::string::npos)
      << result.err;
}

TEST_F(Installed, TheManualPageAndTheCompletionsAreWhereTheyAreLookedFor) {
  EXPECT_TRUE(text_of(prefix_ / "share/man/man1/armature.1").starts_with(".TH ARMATURE 1 "));
  for (const char* file : {"bash-completion/completions/armature", "zsh/site-functions/_armature",
                           "fish/vendor_completions.d/armature.fish"}) {
    EXPECT_NE(text_of(prefix_ / "share" / file).find("__complete"), std::string::npos) << file;
  }
}

TEST_F(Installed, NoFileNamesTheFoldersThatItWasMadeIn) {
  const auto found =
      shell("grep -rl -e '" ARMATURE_SOURCE_DIR "' -e '" ARMATURE_BINARY_DIR "' prefix");
  EXPECT_EQ(found.exit_code, 1) << found.out;
  EXPECT_EQ(found.out, "");
}

}  // namespace
}  // namespace armature::test
