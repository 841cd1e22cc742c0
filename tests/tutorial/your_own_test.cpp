// SPDX-License-Identifier: Apache-2.0
// docs/your_own_*.md do what they say: the "$ ..." lines of a page are run, in order, by one shell.
// So does the README of every new plugin.
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>

#include "armature/values/temporary_folder.hpp"
#include "command.hpp"
#include "tests/dds_domain.hpp"
#include "tests/new_plugins.hpp"
#include "tests/text.hpp"

namespace armature::test {
namespace {

namespace fs = std::filesystem;

/// The lines after "$ " of every ```console block.
std::vector<std::string> commands_of(const std::string& page) {
  std::vector<std::string> commands;
  std::ifstream file{page};
  bool console = false;
  for (std::string line; std::getline(file, line);) {
    if (line.starts_with("```")) console = line == "```console";
    if (console && line.starts_with("$ ")) commands.push_back(line.substr(2));
  }
  return commands;
}

class YourOwn : public testing::Test {
 protected:
  YourOwn() { fs::create_directory_symlink(source_file("configs"), folder_ / "configs"); }

  /// What they print; they all end well.
  std::string run_page(const std::string& page) const {
    const auto commands = commands_of(source_file(page));
    EXPECT_GE(commands.size(), 9U);
    return run_commands(commands, folder_.path(), {});
  }
  static std::string run_commands(const std::vector<std::string>& commands, const fs::path& where,
                                  const Command::Options& options) {
    std::string script = "set -e\ncd " + where.string() + "\n";
    script += "export PATH=" + fs::path{armature()}.parent_path().string() + ":$PATH\n";
    // A reader is alone on his machine; tests are not.
    script += "armature() { local more=; [ \"$1\" = run ] && more='--domain " +
              std::to_string(unique_dds_domain()) + "'; command armature \"$@\" $more; }\n";
    for (const std::string& command : commands) {
      script += "echo '$ " + all_replaced(command, "'", "\"") + "'\n" + command + "\n";
    }
    const auto result =
        run_command({"/bin/bash", "-c", script}, options, std::chrono::seconds{280});
    EXPECT_EQ(result.exit_code, 0) << result.out << result.err;
    EXPECT_FALSE(result.timed_out);
    return result.out;
  }

  const TemporaryFolder folder_;
};

TEST_F(YourOwn, SolverComesAboutAsThePageSays) {
  const std::string out = run_page("docs/your_own_solver.md");
  for (const char* file : {"my_solver/README.md", "bench/solves.csv", "bench/cumulative.svg"}) {
    EXPECT_TRUE(fs::exists(folder_ / file)) << file;
  }
  EXPECT_EQ(out.find("FAIL"), std::string::npos) << out;
}

TEST_F(YourOwn, ArmComesAboutAsThePageSays) {
  const std::string out = run_page("docs/your_own_arm.md");
  EXPECT_EQ(out.find("FAIL"), std::string::npos) << out;
  EXPECT_NE(out.find("tool was off a waypoint"), std::string::npos) << out;
}

TEST_F(YourOwn, ComponentComesAboutAsThePageSays) {
  const std::string out = run_page("docs/your_own_component.md");
  EXPECT_EQ(out.find("FAIL"), std::string::npos) << out;
  EXPECT_NE(out.find("top speed of the tool"), std::string::npos) << out;
  EXPECT_NE(out.find("\nrefused, as it should be\n"), std::string::npos) << out;
}

TEST_F(YourOwn, CameraComesAboutAsThePageSays) {
  const std::string out = run_page("docs/your_own_camera.md");
  EXPECT_EQ(out.find("FAIL"), std::string::npos) << out;
  EXPECT_NE(out.find("oldest picture when it was published"), std::string::npos) << out;
  EXPECT_NE(out.find("\nrefused, as it should be\n"), std::string::npos) << out;
}

/// What is indented, but for the lines that build: that was done for all of them at once.
TEST_F(YourOwn, EveryFamilysReadmeSaysWhatWorks) {
  const NewPlugins plugins{ARMATURE_BINARY_DIR "/tests/new_plugins_alone"};
  plugins.write();
  plugins.build(false);
  for (const std::string& family : plugins.families()) {
    std::vector<std::string> commands;
    std::ifstream readme{plugins.folder(family) / "README.md"};
    for (std::string line; std::getline(readme, line);) {
      if (line.starts_with("    armature ")) commands.push_back(line.substr(4));
    }
    EXPECT_GE(commands.size(), 2U) << family;
    for (std::string& command : commands) {
      command = all_replaced(command, "--poses 10000", "--poses 200");
    }
    run_commands(commands, plugins.folder(family), plugins.environment());
  }
}

}  // namespace
}  // namespace armature::test
