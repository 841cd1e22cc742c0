// SPDX-License-Identifier: Apache-2.0
// docs/your_own_solver.md and docs/your_own_arm.md do what they say: the "$ ..." lines of a page
// are run, in order, by one shell.
#include <gtest/gtest.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <sstream>

#include "command.hpp"
#include "tests/dds_domain.hpp"

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
  YourOwn() {
    fs::create_directories(folder_);
    fs::create_directory_symlink(source_file("configs"), folder_ / "configs");
  }
  ~YourOwn() override { fs::remove_all(folder_); }

  /// What they print; they all end well.
  std::string run_page(const std::string& page) const {
    const auto commands = commands_of(source_file(page));
    EXPECT_GE(commands.size(), 9U);
    std::string script = "set -e\ncd " + folder_.string() + "\n";
    script += "export PATH=" + fs::path{armature()}.parent_path().string() + ":$PATH\n";
    // A reader is alone on his machine; tests are not.
    script += "armature() { local more=; [ \"$1\" = run ] && more='--domain " +
              std::to_string(unique_dds_domain()) + "'; command armature \"$@\" $more; }\n";
    for (const std::string& command : commands) {
      script += "echo '$ " + command + "'\n" + command + "\n";
    }
    const auto result = run_command({"/bin/bash", "-c", script}, {}, std::chrono::seconds{280});
    EXPECT_EQ(result.exit_code, 0) << result.out << result.err;
    EXPECT_FALSE(result.timed_out);
    return result.out;
  }

  const fs::path folder_ =
      fs::temp_directory_path() / ("armature-tutorial-" + std::to_string(getpid()));
};

TEST_F(YourOwn, SolverComesAboutAsThePageSays) {
  const std::string out = run_page("docs/your_own_solver.md");
  for (const char* file : {"mine/README.md", "bench/solves.csv", "bench/cumulative.svg"}) {
    EXPECT_TRUE(fs::exists(folder_ / file)) << file;
  }
  EXPECT_EQ(out.find("FAIL"), std::string::npos) << out;
}

TEST_F(YourOwn, ArmComesAboutAsThePageSays) {
  const std::string out = run_page("docs/your_own_arm.md");
  EXPECT_EQ(out.find("FAIL"), std::string::npos) << out;
  EXPECT_NE(out.find("tool was off a waypoint"), std::string::npos) << out;
}

}  // namespace
}  // namespace armature::test
