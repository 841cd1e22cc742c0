// SPDX-License-Identifier: Apache-2.0
// docs/your_own_solver.md does what it says: its "$ ..." lines are run, in order, by one shell.
#include <gtest/gtest.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <sstream>

#include "command.hpp"

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

class YourOwnSolver : public testing::Test {
 protected:
  YourOwnSolver() {
    fs::create_directories(folder_);
    fs::create_directory_symlink(source_file("configs"), folder_ / "configs");
  }
  ~YourOwnSolver() override { fs::remove_all(folder_); }

  const fs::path folder_ =
      fs::temp_directory_path() / ("armature-tutorial-" + std::to_string(getpid()));
};

TEST_F(YourOwnSolver, EveryCommandOfThePageDoesWhatItSays) {
  const auto commands = commands_of(source_file("docs/your_own_solver.md"));
  ASSERT_GE(commands.size(), 9U);
  std::string script = "set -e\ncd " + folder_.string() + "\n";
  script += "export PATH=" + fs::path{armature()}.parent_path().string() + ":$PATH\n";
  for (const std::string& command : commands)
    script += "echo '$ " + command + "'\n" + command + "\n";
  const auto result = run_command({"/bin/bash", "-c", script}, {}, std::chrono::seconds{280});
  EXPECT_EQ(result.exit_code, 0) << result.out << result.err;
  EXPECT_FALSE(result.timed_out);
  for (const char* file : {"mine/README.md", "bench/solves.csv", "bench/cumulative.svg"}) {
    EXPECT_TRUE(fs::exists(folder_ / file)) << file;
  }
  EXPECT_EQ(result.out.find("FAIL"), std::string::npos) << result.out;
}

}  // namespace
}  // namespace armature::test
