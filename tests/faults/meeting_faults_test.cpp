// SPDX-License-Identifier: Apache-2.0
// Nothing is activated before a deployment's processes have met: a run that does not begin names
// what it waited for.
#include <gmock/gmock.h>

#include <csignal>
#include <filesystem>
#include <fstream>
#include <string>

#include "armature/values/temporary_folder.hpp"
#include "command.hpp"
#include "tests/dds_domain.hpp"

namespace armature::test {
namespace {

using std::chrono::seconds;
using testing::HasSubstr;

class Meeting : public testing::Test {
 protected:
  std::vector<std::string> command() const {
    return {armature(), "run",      source_file("tests/end_to_end/pulse.yaml"),
            "--json",   "--domain", std::to_string(domain_)};
  }
  const int domain_ = unique_dds_domain();
};

TEST_F(Meeting, ThatDoesNotComeAboutEndsTheRunBeforeItsStartAndNamesTopicAndProcess) {
  const std::string path = std::string{DEAF_TRANSPORT} + ":" + TEST_PLUGINS;
  const CommandResult result = run_command(
      command(), {.environment = {{"ARMATURE_PLUGIN_PATH", path}}, .input = {}}, seconds{30});
  EXPECT_EQ(result.exit_code, 1);
  const std::string reason =
      "not started: topic '/pulse/beat' of process 'main' has not met process 'aside' within ";
  EXPECT_THAT(result.out, HasSubstr(R"({"status":"not_started","reason":")" + reason));
  EXPECT_THAT(result.err, HasSubstr("armature: " + reason));
}

TEST_F(Meeting, WithoutALoopbackInterfaceSaysSo) {
  const std::vector<std::string> alone{"/usr/bin/unshare", "-rn"};
  auto probe = alone;
  probe.push_back("/bin/true");
  if (run_command(probe).exit_code != 0) GTEST_SKIP() << "no network namespace may be made here";
  auto words = alone;
  for (const auto& word : command()) words.push_back(word);
  const CommandResult result = run_command(
      words, {.environment = {{"ARMATURE_PLUGIN_PATH", TEST_PLUGINS}}, .input = {}}, seconds{30});
  EXPECT_EQ(result.exit_code, 1) << result.out;
  EXPECT_THAT(result.err, HasSubstr("loopback interface")) << result.err;
}

bool is_process_of_a_deployment(pid_t pid) {
  std::ifstream words{"/proc/" + std::to_string(pid) + "/cmdline"};
  std::string word;  // an iterator would throw when the process ends meanwhile
  while (std::getline(words, word, '\0')) {
    if (word == "--process") return true;
  }
  return false;
}

TEST_F(Meeting, AProcessThatIsKilledBeforeItEndsTheRunBeforeItsStartIsolatedOrNot) {
  const std::string path = std::string{DEAF_TRANSPORT} + ":" + TEST_PLUGINS;
  for (const std::string on_fault : {"stop", "isolate"}) {
    auto words = command();
    words.insert(words.end(), {"--set", "components.beat.on_fault=" + on_fault});
    Command run{words, {.environment = {{"ARMATURE_PLUGIN_PATH", path}}, .input = {}}};
    // Plugins are tried in processes of their own before.
    pid_t aside = 0;
    while (!is_process_of_a_deployment(aside = run.child())) {
    }
    kill(aside, SIGKILL);
    const CommandResult result = run.finish(seconds{30});
    EXPECT_EQ(result.exit_code, 1);
    EXPECT_THAT(result.err, HasSubstr("armature: process 'aside' (pid " + std::to_string(aside) +
                                      ") was killed by signal 9 (Killed) before the start"));
  }
}

TEST_F(Meeting, ThatIsInterruptedIsNoRunAndLeavesNoRecording) {
  const TemporaryFolder folder;
  const std::filesystem::path recording = folder / "run.mcap";
  auto words = command();
  words.insert(words.end(), {"--set", "components.beat.params.construction_s=100", "--set",
                             "record={file: " + recording.string() + "}"});
  Command run{words, {.environment = {{"ARMATURE_PLUGIN_PATH", TEST_PLUGINS}}, .input = {}}};
  ASSERT_TRUE(run.wait_for_err("being constructed", seconds{30})) << run.err();
  ASSERT_TRUE(run.wait_for_err("waiting for process 'aside'", seconds{30})) << run.err();
  run.signal(SIGINT);
  const CommandResult result = run.finish(seconds{30});
  EXPECT_EQ(result.exit_code, 1);
  EXPECT_EQ(result.out,
            "{\"status\":\"not_started\",\"reason\":\"interrupted before the start\"}\n");
  EXPECT_FALSE(std::filesystem::exists(recording));
}

TEST_F(Meeting, ThatIsInterruptedLeavesNoRecordingOfAProcessThatWasSlowerEither) {
  const TemporaryFolder folder;
  auto words = command();
  words.insert(words.end(), {"--set", "components.beat.params.construction_s=1", "--set",
                             "record={file: " + (folder / "run.mcap").string() + "}"});
  Command run{words, {.environment = {{"ARMATURE_PLUGIN_PATH", TEST_PLUGINS}}, .input = {}}};
  ASSERT_TRUE(run.wait_for_err("being constructed", seconds{30})) << run.err();
  run.signal(SIGINT);
  const CommandResult result = run.finish(seconds{30});
  EXPECT_THAT(result.err, HasSubstr("interrupted before the start"));
  EXPECT_TRUE(std::filesystem::is_empty(folder.path()));
}

TEST_F(Meeting, OfProcessesThatAreStartedByHandIsNoRunEitherWhenItIsInterrupted) {
  const TemporaryFolder folder;
  for (const std::string process : {"main", "aside"}) {
    auto words = command();
    words.insert(words.end(), {"--process", process, "--set",
                               "record={file: " + (folder / "run.mcap").string() + "}"});
    Command run{words, {.environment = {{"ARMATURE_PLUGIN_PATH", TEST_PLUGINS}}, .input = {}}};
    ASSERT_TRUE(run.wait_for_err("waiting: topic '/pulse/", seconds{30})) << run.err();
    run.signal(SIGINT);
    const CommandResult result = run.finish(seconds{30});
    EXPECT_EQ(result.exit_code, 1);
    EXPECT_EQ(result.out,
              "{\"status\":\"not_started\",\"reason\":\"interrupted before the start\"}\n");
    EXPECT_TRUE(std::filesystem::is_empty(folder.path()));
  }
}

TEST_F(Meeting, OfProcessesThatAreStartedByHandIsOneForAllHoweverShortTheRunIs) {
  const auto start = [&](const std::string& process) {
    auto words = command();
    words.insert(words.end(), {"--process", process, "--set", "run.time_limit_s=0.001"});
    return words;
  };
  const Command::Options options{.environment = {{"ARMATURE_PLUGIN_PATH", TEST_PLUGINS}},
                                 .input = {}};
  for (int run = 0; run < 3; ++run) {
    Command aside{start("aside"), options};
    const CommandResult main = run_command(start("main"), options, seconds{30});
    const CommandResult other = aside.finish(seconds{30});
    for (const CommandResult& one : {main, other}) {
      EXPECT_FALSE(one.timed_out) << one.err;
      EXPECT_THAT(one.err, HasSubstr("stopping: the time limit of 0.001 s is over"));
    }
  }
}

}  // namespace
}  // namespace armature::test
