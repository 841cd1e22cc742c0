// SPDX-License-Identifier: Apache-2.0
// An installed Armature needs nothing of the folder that it was built in: a new plugin's README
// holds for it, too.
#include <gtest/gtest.h>
#include <unistd.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <regex>
#include <sstream>

#include "command.hpp"

namespace armature::test {
namespace {

namespace fs = std::filesystem;

std::string text_of(const fs::path& file) {
  std::ostringstream text;
  text << std::ifstream{file}.rdbuf();
  return text.str();
}

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
  Installed() { fs::remove_all(folder_); }
  ~Installed() override { fs::remove_all(folder_); }

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
    return run_command({"/bin/bash", "-c", "cd " + folder_.string() + "\n" + script}, environment,
                       std::chrono::seconds{200});
  }

  const fs::path folder_ =
      fs::temp_directory_path() / ("armature-installed-" + std::to_string(getpid()));
  const fs::path prefix_ = folder_ / "prefix";
};

TEST_F(Installed, ANewPluginIsBuiltTestedVerifiedMeasuredAndDeployedAsItsReadmeSays) {
  const auto written = shell("armature plugin new ik/mine -o mine");
  ASSERT_EQ(written.exit_code, 0) << written.err;
  EXPECT_NE(text_of(folder_ / "mine/CMakeLists.txt").find(prefix_.string()), std::string::npos);
  const std::string readme = std::regex_replace(text_of(folder_ / "mine/README.md"),
                                                std::regex{"--poses 10000"}, "--poses 200");
  const auto result = shell("cd mine\n" + script_of(readme));
  EXPECT_EQ(result.exit_code, 0) << result.out << result.err;
  for (const char* shown : {"100% tests passed", "loading leaves nothing behind", "times ik/kdl",
                            "SHA-256 of the arm's trajectory"}) {
    EXPECT_NE(result.out.find(shown), std::string::npos) << shown << "\n" << result.out;
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
