// SPDX-License-Identifier: Apache-2.0
// A crashing, a hanging, a foreign and an outdated library in the plugin path: each gives a clear
// message, and stops nothing else.
#include <gtest/gtest.h>

#include <algorithm>
#include <csignal>
#include <filesystem>
#include <fstream>
#include <thread>

#include "armature/values/temporary_folder.hpp"
#include "command.hpp"

namespace armature::test {
namespace {

const Command::Options kFaultyPath{.environment = {{"ARMATURE_PLUGIN_PATH", FAULTY_LIBRARIES}},
                                   .input = {}};
const std::string kLamp = source_file("configs/robots/dental_lamp.yaml");

CommandResult ik_with(const std::string& plugin) {
  return run_command({armature(), "ik", "--robot", kLamp, "--plugin", plugin}, kFaultyPath);
}

TEST(FaultyLibrary, OneThatCrashesIsNamedAndTheProgramLives) {
  const auto result = ik_with("ik/crashing");
  EXPECT_EQ(result.exit_code, 4);
  EXPECT_EQ(result.err, "armature: plugin 'ik/crashing' cannot be used: " FAULTY_LIBRARIES
                        "/crashing.so: it crashes when it is loaded (Aborted)\n");
}

TEST(FaultyLibrary, OneThatCrashesIsNamedAmongSoundOnesThatAreTriedWithIt) {
  const auto result = run_command({armature(), "check", source_file("configs/dental_lamp.yaml"),
                                   "--set", "components.motion.ik.plugin=ik/crashing"},
                                  kFaultyPath);
  EXPECT_EQ(result.exit_code, 4);
  EXPECT_EQ(result.err, "armature: plugin 'ik/crashing' cannot be used: " FAULTY_LIBRARIES
                        "/crashing.so: it crashes when it is loaded (Aborted)\n");
}

/// The process in which a library is tried.
pid_t trial_of(const Command& command) {
  pid_t trial = 0;
  for (int i = 0; i < 3000 && trial == 0; ++i) {
    trial = command.child();
    std::this_thread::sleep_for(std::chrono::milliseconds{10});
  }
  return trial;
}

TEST(FaultyLibrary, OneThatHangsIsNamedAndTheProgramLives) {
  const auto result = ik_with("ik/hanging");
  EXPECT_EQ(result.exit_code, 4);
  EXPECT_EQ(result.err, "armature: plugin 'ik/hanging' cannot be used: " FAULTY_LIBRARIES
                        "/hanging.so: it is not loaded after 5 s\n");
}

/// `id` as the solver of the lamp, which `check` constructs.
CommandResult check_with(const std::string& id) {
  return run_command({armature(), "check", source_file("configs/dental_lamp.yaml"), "--set",
                      "components.motion.ik.plugin=" + id},
                     {.environment = {{"ARMATURE_PLUGIN_PATH", FAULT_PLUGINS}}, .input = {}});
}

TEST(FaultyLibrary, WhatASlotsPluginThrowsIsToldAndDoesNotOutliveIt) {
  const auto result = check_with("ik/throwing");
  EXPECT_EQ(result.exit_code, 3);
  EXPECT_NE(result.err.find(
                "slot 'ik' of component 'motion': ik/throwing: an exception of its own type\n"),
            std::string::npos)
      << result.err;
}

TEST(FaultyLibrary, WhatASolverThrowsInTheCalculatorIsTold) {
  const auto result =
      run_command({armature(), "ik", "--robot", kLamp, "--plugin", "ik/throwing"},
                  {.environment = {{"ARMATURE_PLUGIN_PATH", FAULT_PLUGINS}}, .input = {}});
  EXPECT_LT(result.exit_code, 128);
  EXPECT_NE(result.err.find("ik/throwing: an exception of its own type"), std::string::npos)
      << result.err;
}

TEST(FaultyLibrary, OneThatIsTriedWhenTheRunIsInterruptedSaysNothing) {
  const TemporaryFolder folder;
  const std::filesystem::path deployment = folder / "hanging.yaml";
  std::ofstream{deployment} << "armature: 1\nname: hanging\nrobots: {arm: " << kLamp
                            << "}\ncomponents: {ik: {plugin: ik/hanging}}\n";
  Command run{{armature(), "run", deployment, "--json"}, kFaultyPath};
  const pid_t trial = trial_of(run);
  ASSERT_GT(trial, 0) << run.err();
  kill(trial, SIGINT);  // as Ctrl-C does
  run.signal(SIGINT);
  const CommandResult result = run.finish(std::chrono::seconds{10});
  EXPECT_EQ(std::count(result.out.begin(), result.out.end(), '\n'), 1) << result.out;
}

TEST(FaultyLibrary, OneThatHangsWhileItIsTriedGoesWithTheProgram) {
  Command ik{{armature(), "ik", "--robot", kLamp, "--plugin", "ik/hanging"}, kFaultyPath};
  const pid_t trial = trial_of(ik);
  ASSERT_GT(trial, 0);
  ik.signal(SIGKILL);
  ik.finish(std::chrono::seconds{10});
  EXPECT_TRUE(ends_within(trial, std::chrono::seconds{10}));
}

TEST(FaultyLibrary, OneBuiltForAnotherFrameworkIsRefusedWithBothTags) {
  const auto result = ik_with("ik/old");
  EXPECT_EQ(result.exit_code, 4);
  EXPECT_NE(result.err.find("built for [armature 0, compiler abi 1014], this is [compiler abi "),
            std::string::npos)
      << result.err;
  EXPECT_NE(result.err.find("rebuild the plugin"), std::string::npos);
}

TEST(FaultyLibrary, AForeignOneIsListedWithItsReason) {
  const auto result = run_command({armature(), "plugin", "list"}, kFaultyPath);
  EXPECT_EQ(result.exit_code, 0);
  EXPECT_NE(
      result.err.find("foreign.so cannot be used: not an Armature plugin: it has no manifest"),
      std::string::npos)
      << result.err;
  EXPECT_NE(result.out.find("ik/lamp_geometric"), std::string::npos);
}

TEST(FaultyLibrary, AFileThatIsNoLibraryIsListedWithItsReason) {
  const TemporaryFolder folder;
  std::ofstream{folder / "text.so"} << "just text";
  const auto result =
      run_command({armature(), "plugin", "list"},
                  {.environment = {{"ARMATURE_PLUGIN_PATH", folder.path()}}, .input = {}});
  EXPECT_EQ(result.exit_code, 0);
  EXPECT_NE(result.err.find("text.so cannot be used: not a 64-bit ELF library"), std::string::npos)
      << result.err;
}

TEST(FaultyLibrary, StopsNoOther) {
  const auto result =
      run_command({armature(), "ik", "--robot", kLamp, "--plugin", "ik/lamp_geometric"},
                  {.environment = kFaultyPath.environment,
                   .input = R"({"position_m":[1.3,0.321,0.504],"direction":[1,0,0]})"});
  EXPECT_EQ(result.exit_code, 0);
  EXPECT_NE(result.out.find("\"ok\""), std::string::npos);
}

}  // namespace
}  // namespace armature::test
