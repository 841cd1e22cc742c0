// SPDX-License-Identifier: Apache-2.0
// What people expect of any program of the command line.
#include <gmock/gmock.h>

#include <chrono>
#include <filesystem>

#include "armature/values/temporary_folder.hpp"
#include "command.hpp"

namespace armature::test {
namespace {

using testing::HasSubstr;
using testing::MatchesRegex;

TEST(TheCommandLine, TellsItsVersion) {
  const auto told = run_command({armature(), "--version"});
  EXPECT_EQ(told.exit_code, 0);
  EXPECT_THAT(told.out, MatchesRegex("armature [0-9]+\\.[0-9]+\\.[0-9]+\n"));
}

TEST(TheCommandLine, HelpsWithAVerb) {
  const auto asked = run_command({armature(), "help", "run"});
  EXPECT_EQ(asked.exit_code, 0);
  EXPECT_EQ(asked.out, run_command({armature(), "run", "--help"}).out);
  EXPECT_EQ(run_command({armature(), "help", "plugin", "new"}).out,
            run_command({armature(), "plugin", "new", "--help"}).out);
  EXPECT_EQ(run_command({armature(), "help"}).out, run_command({armature(), "--help"}).out);
}

TEST(TheCommandLine, NamesTheVerbThatAMisspelledOneIsNearestTo) {
  const auto wrong = run_command({armature(), "rnu", "configs/dental_lamp.yaml"});
  EXPECT_EQ(wrong.exit_code, 2);
  EXPECT_EQ(wrong.err, "'armature' has no verb 'rnu'; did you mean 'run'?\n");
  const auto nested = run_command({armature(), "plugin", "lsit"});
  EXPECT_EQ(nested.exit_code, 2);
  EXPECT_EQ(nested.err, "'plugin' has no verb 'lsit'; did you mean 'list'?\n");
}

TEST(TheCommandLine, FindsAShippedDeploymentByItsNameFromAnyFolder) {
  const auto found = run_command({armature(), "check", "dental_lamp"});
  EXPECT_EQ(found.exit_code, 0) << found.err;
  const auto wrong = run_command({armature(), "check", "dental_lmp"});
  EXPECT_EQ(wrong.exit_code, 3);
  EXPECT_THAT(wrong.err, HasSubstr("there is no file 'dental_lmp' here, and no deployment "
                                   "'dental_lmp' came with armature; did you mean 'dental_lamp'"));
}

TEST(TheCommandLine, ANameThatCannotBeLookedUpIsNoFile) {
  const TemporaryFolder folder;
  std::filesystem::create_symlink("loop", folder / "loop");
  for (const std::string& name : {std::string(300, 'a'), std::string{"loop"}}) {
    const auto wrong =
        run_command({"/usr/bin/env", "-C", folder.path().string(), armature(), "check", name});
    EXPECT_EQ(wrong.exit_code, 3) << wrong.err;
    EXPECT_THAT(wrong.err, HasSubstr("there is no file '" + name.substr(0, 4)));
  }
}

TEST(TheCommandLine, AFolderDoesNotHideTheShippedDeploymentOfItsName) {
  const TemporaryFolder folder;
  std::filesystem::create_directory(folder / "dental_lamp");
  const auto found = run_command(
      {"/usr/bin/env", "-C", folder.path().string(), armature(), "check", "dental_lamp"});
  EXPECT_EQ(found.exit_code, 0) << found.err;
}

TEST(TheCommandLine, FindsItsPluginsSoundThoughItsParentIgnoresTheEndsOfChildren) {
  const auto checked =
      run_command({"/bin/sh", "-c", "trap '' CHLD; exec \"$0\" check sr1_biopsy", armature()});
  EXPECT_EQ(checked.exit_code, 0) << checked.err;
}

TEST(TheCommandLine, HelpThatCannotBePrintedWasNotGiven) {
  const auto lost = run_command({"/bin/sh", "-c", "\"$0\" run --help > /dev/full", armature()});
  EXPECT_EQ(lost.exit_code, 1);
  EXPECT_THAT(lost.err, HasSubstr("standard output cannot be written"));
}

TEST(TheCommandLine, RefusesAnOptionThatWouldDoNothing) {
  const std::string file = source_file("README.md");
  for (std::vector<std::string> words : std::vector<std::vector<std::string>>{
           {"replay", file, "--check", "--domain", "3"},
           {"replay", file, "--set", "seed=3", "--no-shared-memory"},
           {"replay", file, "--allow-ulp"},
           {"operator", "dental_lamp", "--step", "search"},
           {"operator", "dental_lamp", "--say", "pause", "--step", "search"},
           {"graph", "dental_lamp", "--timeout", "3"},
           {"graph", "--live", "--set", "seed=3"}}) {
    words.insert(words.begin(), armature());
    const auto refused = run_command(words, {}, std::chrono::seconds{10});
    EXPECT_EQ(refused.exit_code, 2) << words[1] << ' ' << words.back() << ": " << refused.err;
  }
}

TEST(TheCommandLine, TakesNoEmptyNameForAFolderThatNobodyWants) {
  for (const std::vector<std::string>& words :
       {std::vector<std::string>{"run", "dental_lamp", "--report", ""},
        {"workspace", "--out", ""},
        {"sweep", "sr1_biopsy", "--out", ""},
        {"reproduce", "lamp", "--out", ""}}) {
    std::vector<std::string> command{armature()};
    command.insert(command.end(), words.begin(), words.end());
    const auto wrong = run_command(command);
    EXPECT_EQ(wrong.exit_code, 2) << words.front();
    EXPECT_THAT(wrong.err, HasSubstr("names nothing: is a variable of the shell empty?"));
  }
}

TEST(TheCommandLine, TakesNoValueForAFileAndSaysWhereItGoes) {
  const auto result =
      run_command({armature(), "check", "dental_lamp", "--set", "clock=simulated", "seed=3"});
  EXPECT_EQ(result.exit_code, 3);
  EXPECT_EQ(result.err,
            "cannot read 'seed=3': No such file or directory; is it a value? Write --set seed=3\n");
}

}  // namespace
}  // namespace armature::test
