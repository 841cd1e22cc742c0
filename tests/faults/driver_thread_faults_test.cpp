// SPDX-License-Identifier: Apache-2.0
// A component with a driver thread, in a run: what the thread reads comes out, and whatever its
// device does, the run ends in time and says what was wrong.
#include <gmock/gmock.h>

#include <chrono>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>

#include "armature/values/sanitizer.hpp"
#include "armature/values/temporary_folder.hpp"
#include "command.hpp"
#include "tests/dds_domain.hpp"

namespace armature::test {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;
using testing::HasSubstr;

constexpr double kReading_s = 0.5;

class DriverThreadFaults : public testing::Test {
 protected:
  DriverThreadFaults() {
    std::ofstream{file_} << "armature: 1\nname: reading\nrun: {time_limit_s: " << kReading_s
                         << "}\ncomponents:\n  reader: {plugin: test/reader}\n";
  }

  CommandResult run(const std::string& setting) {
    const auto start = std::chrono::steady_clock::now();
    const CommandResult result =
        run_command({armature(), "run", file_.string(), "--json", "--domain",
                     std::to_string(unique_dds_domain()), "--set", setting},
                    options_);
    seconds_ = std::chrono::duration<double>{std::chrono::steady_clock::now() - start}.count();
    return result;
  }
  CommandResult run_with(const std::string& device) {
    return run("components.reader.params.device=" + device);
  }

  const TemporaryFolder folder_;
  const fs::path file_ = folder_ / "reading.yaml";
  Command::Options options_{.environment = {{"ARMATURE_PLUGIN_PATH", FAULT_PLUGINS}}, .input = {}};
  double seconds_ = 0;  // that the last run took
};

TEST_F(DriverThreadFaults, WhatTheThreadReadsComesOut) {
  const CommandResult result = run_with("talks");
  EXPECT_EQ(result.exit_code, 0) << result.err;
  EXPECT_GE(json::parse(result.out)["notes"], 3) << "of fifty a second, on a machine that has time";
}

TEST_F(DriverThreadFaults, ADeviceThatIsClosedInStopLetsItsReaderGo) {
  const CommandResult result = run_with("is_closed");
  EXPECT_EQ(result.exit_code, 0) << result.err;
  EXPECT_EQ(json::parse(result.out)["status"], "ok");
}

TEST_F(DriverThreadFaults, AReadThatNeverReturnsIsNamedAndHoldsUpTheEndForASecond) {
  const CommandResult result = run_with("waits");
  EXPECT_EQ(result.exit_code, 1);
  const json told = json::parse(result.out);
  EXPECT_EQ(told["status"], "fault");
  EXPECT_EQ(told["reason"], kSanitized
                                ? "'reader' hangs: its driver thread has not returned for 5 s"
                                : "'reader' hangs: its driver thread has not returned for 1 s");
  EXPECT_LT(seconds_, kSanitized ? 30 : kReading_s + 4) << "1 s, and what a process needs";
}

TEST_F(DriverThreadFaults, AThreadThatThrowsEndsTheRunAsAStepWould) {
  const CommandResult result =
      run("components.reader={plugin: test/reader, on_fault: stop, "
          "params: {device: throws}}");
  EXPECT_EQ(result.exit_code, 1);
  EXPECT_EQ(json::parse(result.out)["reason"], "reader: driver thread failed: the cable is out");
}

TEST_F(DriverThreadFaults, ACrashNamesTheComponentAndItsThread) {
  if (kSanitized) GTEST_SKIP() << "a sanitizer tells of a crash by itself";
  const CommandResult result = run_with("crashes");
  EXPECT_EQ(result.exit_code, 128 + SIGSEGV);
  EXPECT_THAT(result.err,
              HasSubstr("armature: component 'reader' crashed in its driver thread: SIGSEGV\n"));
}

TEST_F(DriverThreadFaults, TheSimulatedClockRefusesItByName) {
  const CommandResult result = run("clock=simulated");
  EXPECT_EQ(result.exit_code, 3);
  EXPECT_THAT(result.err,
              HasSubstr("'test/reader' cannot promise that (its plugin.yaml says "
                        "'pure: false'); choose another plugin or set 'clock: system'"));
}

TEST_F(DriverThreadFaults, ACheckOpensNoDevice) {
  const CommandResult result = run_command(
      {armature(), "check", file_.string(), "--set", "components.reader.params.device=crashes"},
      options_);
  EXPECT_EQ(result.exit_code, 0) << result.err;
}

}  // namespace
}  // namespace armature::test
