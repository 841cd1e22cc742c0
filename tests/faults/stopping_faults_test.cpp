// SPDX-License-Identifier: Apache-2.0
// Plugs that are pulled while something moves: it is at rest before its process ends, whoever else
// has gone already, and who reads what is printed does not matter.
#include <gmock/gmock.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <csignal>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <map>
#include <set>
#include <thread>

#include "armature/values/temporary_folder.hpp"
#include "command.hpp"
#include "tests/dds_domain.hpp"

namespace armature::test {
namespace {

using std::chrono::milliseconds;
using std::chrono::seconds;
using testing::ContainsRegex;
using testing::HasSubstr;
using testing::Not;

constexpr seconds kWithin{30};
constexpr milliseconds kLeaseIsOver{1200};  // of liveliness, with time to spare
constexpr double kRounded_s = 0.0005;       // the time of a line
const std::string kApart = "components.arm.process=aside";

class PulledPlug : public testing::Test {
 protected:
  ~PulledPlug() override {
    // Of a run behind a shell, which is not there any more when the test has failed.
    const std::string pid = file("pid");
    std::ifstream line{"/proc/" + pid.substr(0, pid.find('\n')) + "/cmdline"};
    std::string words;
    std::getline(line, words);
    if (words.find(folder_) != std::string::npos) kill(std::stoi(pid), SIGKILL);
  }

  std::vector<std::string> command(const std::vector<std::string>& settings = {}) {
    std::vector<std::string> words{armature(),
                                   "run",
                                   source_file("tests/faults/halt.yaml"),
                                   "--json",
                                   "--report",
                                   folder_,
                                   "--domain",
                                   std::to_string(domain_)};
    for (const auto& setting : settings) words.insert(words.end(), {"--set", setting});
    return words;
  }
  /// As a line for the shell, in which the process id is told in a file.
  std::string line(const std::vector<std::string>& settings = {}) {
    std::string text = "echo $BASHPID > " + folder_ + "/pid; exec";
    for (const auto& word : command(settings)) text += " '" + word + "'";
    return text;
  }
  std::string file(const std::string& name) const {
    std::ifstream stream{std::filesystem::path{folder_} / name};
    return {std::istreambuf_iterator<char>{stream}, {}};
  }
  std::string report() const { return file("report.json"); }

  const Command::Options options_{.environment = {{"ARMATURE_PLUGIN_PATH", TEST_PLUGINS}},
                                  .input = {}};
  const TemporaryFolder temporary_;
  const std::string folder_ = temporary_.path();
  const int domain_ = unique_dds_domain();
};

const std::string kEndedAtRest = "arm       ended at rest";

TEST_F(PulledPlug, AnInterruptedArmComesToRestInEitherProcess) {
  for (const std::string process : {"main", "aside"}) {
    Command run{command({"components.arm.process=" + process}), options_};
    ASSERT_TRUE(run.wait_for_err("arm       moves", kWithin)) << run.err();
    run.signal(SIGINT);
    const CommandResult result = run.finish(kWithin);
    EXPECT_THAT(result.err, ContainsRegex("runtime   stopping: interrupted\n(.|\n)*at rest\n"));
    EXPECT_THAT(result.err, HasSubstr(kEndedAtRest));
    EXPECT_THAT(result.err, HasSubstr("armature: interrupted\n"));
    EXPECT_THAT(result.out, HasSubstr(R"({"status":"ok")")) << "there is no goal to miss";
  }
}

TEST_F(PulledPlug, EverySignalThatEndsARunIsToldInItsOwnWords) {
  std::signal(SIGHUP, SIG_DFL);  // a run goes on ignoring what its starter ignores, as under nohup
  for (const auto& [signal, words] : std::map<int, std::string>{
           {SIGTERM, "terminated"},
           {SIGHUP, "the terminal was closed"},
           {SIGQUIT, "ended by SIGQUIT"},
           {SIGUSR1, "ended by SIGUSR1"},
           {SIGTSTP, "ended by SIGTSTP"},
           {SIGRTMIN + 1, "ended by signal " + std::to_string(SIGRTMIN + 1)}}) {
    Command run{command(), options_};
    ASSERT_TRUE(run.wait_for_err("arm       moves", kWithin)) << run.err();
    run.signal(signal);
    const CommandResult result = run.finish(kWithin);
    EXPECT_THAT(result.err, HasSubstr("runtime   stopping: " + words + "\n"));
    EXPECT_THAT(result.err, HasSubstr(kEndedAtRest));
    EXPECT_TRUE(result.err.ends_with("armature: " + words + "\n")) << result.err;
  }
}

TEST_F(PulledPlug, AnArmComesToRestThoughAPluginHasTakenTheSignals) {
  Command run{command({"components.taker={plugin: test/beat, topics: taker, params: {takes: "
                       "signals}}"}),
              options_};
  ASSERT_TRUE(run.wait_for_err("has taken SIGINT for itself; it does not keep it", kWithin))
      << run.err();
  ASSERT_TRUE(run.wait_for_err("arm       moves", kWithin)) << run.err();
  run.signal(SIGINT);
  const CommandResult result = run.finish(kWithin);
  EXPECT_THAT(result.err, ContainsRegex("runtime   stopping: interrupted\n(.|\n)*at rest\n"));
  EXPECT_THAT(result.err, HasSubstr(kEndedAtRest));
}

/// The signals that a process handles.
std::set<int> handled_by(pid_t pid) {
  std::ifstream status{"/proc/" + std::to_string(pid) + "/status"};
  std::set<int> handled;
  for (std::string line; std::getline(status, line);) {
    if (!line.starts_with("SigCgt:")) continue;
    const auto mask = std::stoull(line.substr(line.find('\t')), nullptr, 16);
    for (int signal = 1; signal <= 64; ++signal) {
      if (mask >> (signal - 1) & 1) handled.insert(signal);
    }
  }
  return handled;
}

TEST_F(PulledPlug, NoSignalButThatOfACrashEndsAProcessWhoseArmMoves) {
  std::signal(SIGHUP, SIG_DFL);
  Command run{command({kApart}), options_};
  ASSERT_TRUE(run.wait_for_err("arm       moves", kWithin)) << run.err();
  std::set<int> end_it{SIGHUP,    SIGINT,  SIGQUIT, SIGUSR1, SIGUSR2,   SIGPIPE, SIGALRM, SIGTERM,
                       SIGSTKFLT, SIGXCPU, SIGXFSZ, SIGPROF, SIGVTALRM, SIGPOLL, SIGPWR};
  for (int signal = SIGRTMIN; signal <= SIGRTMAX; ++signal) end_it.insert(signal);
  for (const pid_t pid : {run.pid(), run.child()}) {
    EXPECT_THAT(handled_by(pid), testing::IsSupersetOf(end_it)) << run.err();
  }
  run.signal(SIGINT);
  run.finish(kWithin);
}

TEST_F(PulledPlug, ASignalThatIsNoOperatorsDoesNotEndAtOnceHoweverOftenItComes) {
  Command run{command({"components.arm.params.rest_after_s=1000", "run.stop_within_s=1.5"}),
              options_};
  ASSERT_TRUE(run.wait_for_err("arm       moves", kWithin)) << run.err();
  for (int i = 0; i < 5; ++i) {
    run.signal(SIGALRM);
    std::this_thread::sleep_for(milliseconds{50});
  }
  const CommandResult result = run.finish(kWithin);
  EXPECT_THAT(result.err, HasSubstr("runtime   stopping: ended by SIGALRM\n"));
  EXPECT_THAT(result.err, Not(HasSubstr("third signal")));
  EXPECT_THAT(result.out, HasSubstr("'arm' was not at rest 1.5 s after it was to stop"));
}

/// The time of the run's own line that says `text`; NaN without one.
double said_at_s(const std::string& text, const std::string& lines) {
  const std::size_t at = lines.find(text);
  if (at == std::string::npos) return std::nan("");
  return std::stod(lines.substr(lines.rfind('[', at) + 1));
}

TEST_F(PulledPlug, StoppingIsSaidWithinAFifthOfASecondAfterTheSignal) {
  for (const std::string signalled : {"main", "aside"}) {
    // The lines of the run count from here, by the clock that both processes share.
    const auto start = std::chrono::steady_clock::now();
    auto words = command({kApart});
    words.insert(words.end(), {"--clock-offset-ns", "0", "--clock-start-ns",
                               std::to_string(start.time_since_epoch().count())});
    Command run{words, options_};
    ASSERT_TRUE(run.wait_for_err("arm       moves", kWithin)) << run.err();
    const pid_t pid = signalled == "main" ? run.pid() : run.child();
    const std::chrono::duration<double> now = std::chrono::steady_clock::now() - start;
    kill(pid, SIGINT);
    const CommandResult result = run.finish(kWithin);
    const std::string by = signalled == "main" ? "" : "process 'aside': ";
    const double said_s = said_at_s("runtime   stopping: " + by + "interrupted\n", result.err);
    EXPECT_GE(said_s, now.count() - kRounded_s) << result.err;
    EXPECT_LE(said_s, now.count() + 0.2) << result.err;
  }
}

TEST_F(PulledPlug, AProcessWithADriverEndsAfterAllOthersHaveEnded) {
  Command run{command({kApart, "components.beat.process=other", "components.beat.params.stop_s=0.3",
                       "components.last={plugin: test/beat, topics: last, params: {stop_s: 0.3}}"}),
              options_};
  ASSERT_TRUE(run.wait_for_err("arm       moves", kWithin)) << run.err();
  run.signal(SIGINT);
  const CommandResult result = run.finish(kWithin);
  EXPECT_THAT(result.err, ContainsRegex("arm       at rest\n(.|\n)*beat      ended\n(.|\n)*"
                                        "last      ended\n(.|\n)*arm       ended at rest\n"));
}

TEST_F(PulledPlug, ASecondProcessOfTheSameNameIsRefusedAndTheFirstGoesOn) {
  // What it commands would be taken: it is the same deployment.
  Command run{command({kApart}), options_};
  ASSERT_TRUE(run.wait_for_err("arm       moves", kWithin)) << run.err();
  const pid_t first = run.child();
  auto words = command({kApart});
  const auto report = std::ranges::find(words, "--report");
  words.erase(report, report + 2);  // which is of the whole run
  words.insert(words.end(), {"--process", "aside"});
  const CommandResult second = run_command(words, options_, kWithin);
  EXPECT_EQ(second.exit_code, 1);
  EXPECT_EQ(second.err, "armature: process 'aside' of deployment 'halt' already runs as pid " +
                            std::to_string(first) + " on domain " + std::to_string(domain_) +
                            "; stop it, or use another domain with --domain\n");
  EXPECT_THAT(run.err(), Not(HasSubstr("stopping:")));
  run.signal(SIGINT);
  EXPECT_THAT(run.finish(kWithin).err, HasSubstr(kEndedAtRest));
}

TEST_F(PulledPlug, AnArmWhoseMainProcessIsKilledComesToRestByItselfAndEnds) {
  Command run{command({kApart}), options_};
  ASSERT_TRUE(run.wait_for_err("arm       moves", kWithin)) << run.err();
  const pid_t aside = run.child();
  run.signal(SIGKILL);
  EXPECT_TRUE(run.wait_for_err("runtime   stopping: the main process is gone", kWithin));
  EXPECT_TRUE(run.wait_for_err(kEndedAtRest, kWithin)) << run.err();
  EXPECT_TRUE(ends_within(aside, kWithin));
}

TEST_F(PulledPlug, AnArmWhoseOtherProcessIsKilledComesToRestAndTheSignalIsTold) {
  Command run{command({"components.beat.process=aside", "components.beat.on_fault=stop"}),
              options_};
  ASSERT_TRUE(run.wait_for_err("arm       moves", kWithin)) << run.err();
  const pid_t aside = run.child();
  kill(aside, SIGSEGV);
  const CommandResult result = run.finish(kWithin);
  const std::string lost = "process 'aside' (pid " + std::to_string(aside) +
                           ") was killed by signal 11 (Segmentation fault)";
  EXPECT_THAT(result.err, HasSubstr("stopping: " + lost));
  EXPECT_THAT(result.err, HasSubstr(kEndedAtRest));
  EXPECT_THAT(result.out, HasSubstr(R"({"status":"fault","reason":")" + lost));
  EXPECT_EQ(result.exit_code, 1);
}

/// The files in shared memory that a process has mapped.
std::set<std::string> shared_memory_of(pid_t pid) {
  std::set<std::string> files;
  std::ifstream maps{"/proc/" + std::to_string(pid) + "/maps"};
  for (std::string line; std::getline(maps, line);) {
    const std::size_t path = line.find("/dev/shm/fastrtps_");
    if (path != std::string::npos) files.insert(line.substr(path));
  }
  return files;
}

TEST_F(PulledPlug, TheEndOfAProcessIsSeenWhereALibraryIgnoresTheEndsOfChildren) {
  Command run{command({kApart, "components.beat.params.ignores_children=true"}), options_};
  ASSERT_TRUE(run.wait_for_err("arm       moves", kWithin)) << run.err();
  const pid_t aside = run.child();
  run.signal(SIGINT);
  const CommandResult result = run.finish(kWithin);
  EXPECT_FALSE(result.timed_out);
  EXPECT_THAT(result.err, HasSubstr(kEndedAtRest));
  EXPECT_THAT(result.out, HasSubstr("process 'aside' (pid " + std::to_string(aside) +
                                    ") has ended, and something else in this process took its "
                                    "exit code"));
}

TEST_F(PulledPlug, AKilledProcessWhoseComponentsAreIsolatedLeavesTheArmMoving) {
  Command run{command({"components.beat.process=aside"}), options_};
  ASSERT_TRUE(run.wait_for_err("arm       moves", kWithin)) << run.err();
  const pid_t aside = run.child();
  EXPECT_TRUE(shared_memory_of(aside).empty()) << "a lock there would outlive it";
  EXPECT_FALSE(shared_memory_of(run.pid()).empty());
  kill(aside, SIGKILL);
  const std::string lost =
      "process 'aside' (pid " + std::to_string(aside) + ") was killed by signal 9 (Killed)";
  ASSERT_TRUE(run.wait_for_err(lost + ", isolated: the run goes on without it\n", kWithin))
      << run.err();
  std::this_thread::sleep_for(kLeaseIsOver);
  EXPECT_THAT(run.err(), Not(HasSubstr("stopping:")));
  run.signal(SIGINT);
  const CommandResult result = run.finish(kWithin);
  EXPECT_THAT(result.err, HasSubstr("runtime   stopping: interrupted\n"));
  EXPECT_THAT(result.err, HasSubstr(kEndedAtRest));
  EXPECT_THAT(result.out, HasSubstr(R"({"status":"fault","reason":")" + lost +
                                    " (the run went on without it)"));
  EXPECT_EQ(result.exit_code, 1);
}

TEST_F(PulledPlug, AProcessThatWasStoppedForLongerThanItsLeaseMakesTheStatusNotOk) {
  Command run{command({kApart}), options_};
  ASSERT_TRUE(run.wait_for_err("arm       moves", kWithin)) << run.err();
  const pid_t aside = run.child();
  kill(aside, SIGSTOP);
  std::this_thread::sleep_for(kLeaseIsOver);
  kill(aside, SIGCONT);
  std::this_thread::sleep_for(milliseconds{200});
  run.signal(SIGINT);
  const CommandResult result = run.finish(kWithin);
  EXPECT_THAT(result.out,
              HasSubstr(R"({"status":"fault","reason":"process 'aside' (pid )" +
                        std::to_string(aside) + ") fell silent: it was stopped for 1."));
  EXPECT_THAT(result.err, HasSubstr(kEndedAtRest));
}

TEST_F(PulledPlug, AReaderThatGoesAwayEndsTheRunInOrder) {
  const CommandResult result = run_command(
      {"/bin/bash", "-c", "(" + line() + ") 2>&1 >" + folder_ + "/out | grep -m1 moves"}, options_,
      kWithin);
  EXPECT_THAT(result.out, HasSubstr("arm       moves"));
  ASSERT_TRUE(ends_within(std::stoi(file("pid")), kWithin));
  EXPECT_THAT(report(), Not(HasSubstr(R"("steps_to_rest":"0")")));
  EXPECT_THAT(report(), HasSubstr(R"("steps_to_rest":)"));
}

TEST_F(PulledPlug, AFullDiskUnderTheLinesDoesNotStopTheArm) {
  Command run{{"/bin/bash", "-c", "(" + line() + ") 2>/dev/full >" + folder_ + "/out"}, options_};
  std::this_thread::sleep_for(seconds{5});
  const pid_t pid = std::stoi(file("pid"));
  EXPECT_EQ(kill(pid, SIGINT), 0);
  EXPECT_TRUE(ends_within(pid, kWithin));
  EXPECT_THAT(report(), ContainsRegex(R"("steps_to_rest":"[1-9])"));
  EXPECT_THAT(report(), HasSubstr(R"("ended_by":"interrupted")"));
}

TEST_F(PulledPlug, LinesThatNobodyReadsDelayNeitherTheArmNorItsEnd) {
  // The reader keeps the pipe open and takes nothing until the run is over.
  Command run{{"/bin/bash", "-c",
               "(" + line({"components.arm.params.talks=true"}) + ") 2>&1 >" + folder_ +
                   "/out | (while [ ! -e " + folder_ + "/read ]; do sleep 0.1; done; cat)"},
              options_};
  // A pipe takes 64 KiB, the queue 256 lines: both are full after four seconds.
  std::this_thread::sleep_for(seconds{5});
  const pid_t pid = std::stoi(file("pid"));
  kill(pid, SIGINT);
  EXPECT_TRUE(ends_within(pid, kWithin));
  EXPECT_THAT(report(), ContainsRegex(R"("steps_to_rest":"[1-9])"));
  std::ofstream{folder_ + "/read"};
  run.finish(kWithin);
}

TEST_F(PulledPlug, LinesThatWereDroppedAreCountedAsSoonAsSomebodyReads) {
  // The reader stands still for 8 s from when the arm moves: pipe and queue are full then.
  Command run{{"/bin/bash", "-c",
               "(" + line({"components.arm.params.talks=true"}) + ") 2>&1 >" + folder_ +
                   "/out | (while read -r told; do [[ $told != *moves* ]] || break; done; "
                   "sleep 8; cat)"},
              options_};
  EXPECT_TRUE(run.wait_for_out(" lines are missing here: nobody read them in time", kWithin));
  kill(std::stoi(file("pid")), SIGINT);
  EXPECT_TRUE(run.finish(kWithin).out.ends_with("armature: interrupted\n"));
}

TEST_F(PulledPlug, AClosedTerminalIsNoneOfTheThreeSignalsThatEndAtOnce) {
  std::signal(SIGHUP, SIG_DFL);  // a run goes on ignoring what its starter ignores, as under nohup
  Command run{command({"components.arm.params.rest_after_s=1000", "run.stop_within_s=100"}),
              options_};
  ASSERT_TRUE(run.wait_for_err("arm       moves", kWithin)) << run.err();
  run.signal(SIGHUP);
  ASSERT_TRUE(run.wait_for_err("stopping: the terminal was closed", kWithin)) << run.err();
  run.signal(SIGTERM);
  ASSERT_TRUE(run.wait_for_err("stopping, at most ", kWithin)) << run.err();
  run.signal(SIGTERM);
  std::this_thread::sleep_for(std::chrono::milliseconds{500});
  EXPECT_THAT(run.err(), Not(HasSubstr("ended at once"))) << "somebody has asked twice only";
  run.signal(SIGTERM);
  EXPECT_THAT(run.finish(seconds{5}).err, HasSubstr("ended at once by a third signal"));
}

TEST_F(PulledPlug, ASecondSignalIsToldHowLongItTakesAndTheThirdEndsAtOnce) {
  Command run{command({"components.arm.params.rest_after_s=1000", "run.stop_within_s=100"}),
              options_};
  ASSERT_TRUE(run.wait_for_err("arm       moves", kWithin)) << run.err();
  run.signal(SIGINT);
  ASSERT_TRUE(run.wait_for_err("stopping: interrupted", kWithin)) << run.err();
  run.signal(SIGINT);
  ASSERT_TRUE(run.wait_for_err("stopping, at most ", kWithin)) << run.err();
  EXPECT_THAT(run.err(),
              ContainsRegex("stopping, at most [0-9.]+ s more; a third signal ends at once\n"));
  run.signal(SIGINT);
  const CommandResult result = run.finish(seconds{5});
  EXPECT_EQ(result.exit_code, 1);
  EXPECT_THAT(result.err, HasSubstr("ended at once by a third signal, before everything was at"));
  EXPECT_THAT(result.out, HasSubstr(R"({"status":"fault","reason":"ended at once by a third)"));
  EXPECT_EQ(report(), result.out);
}

TEST_F(PulledPlug, AnArmThatDoesNotComeToRestIsNamedWithItsProcess) {
  for (const std::string process : {"main", "aside"}) {
    Command run{command({"components.arm.process=" + process,
                         "components.arm.params.rest_after_s=1000", "run.stop_within_s=0.3"}),
                options_};
    ASSERT_TRUE(run.wait_for_err("arm       moves", kWithin)) << run.err();
    run.signal(SIGTERM);
    const CommandResult result = run.finish(kWithin);
    const std::string where = process == "main" ? "" : " in process 'aside'";
    EXPECT_THAT(result.out, HasSubstr(R"({"status":"fault","reason":"'arm')" + where +
                                      " was not at rest 0.3 s after it was to stop"));
    EXPECT_EQ(result.exit_code, 1);
  }
}

TEST_F(PulledPlug, AStepThatDoesNotReturnIsNamedAndTheProcessLeavesAllTheSame) {
  Command run{command({"components.beat.process=aside", "components.arm.params.hangs_after_s=0.2",
                       "run.stop_within_s=0.3"}),
              options_};
  ASSERT_TRUE(run.wait_for_err("arm       moves", kWithin)) << run.err();
  std::this_thread::sleep_for(milliseconds{500});
  const pid_t aside = run.child();
  run.signal(SIGINT);
  const CommandResult result = run.finish(kWithin);
  EXPECT_FALSE(result.timed_out);
  EXPECT_EQ(result.exit_code, 1);
  EXPECT_THAT(result.out,
              HasSubstr(R"({"status":"fault","reason":"the step of 'arm' has not returned for)"));
  EXPECT_THAT(result.out, HasSubstr("'arm' hangs: its step has not returned"));
  EXPECT_EQ(report(), result.out);
  EXPECT_TRUE(ends_within(aside, seconds{1}));
}

struct Hang {
  std::string function, phase;
};
class PulledPlugOfAComponent : public PulledPlug, public testing::WithParamInterface<Hang> {};

TEST_P(PulledPlugOfAComponent, ThatDoesNotEndNamesItAndTheProcessLeavesAllTheSame) {
  Command run{command({"components.beat.params.hangs_in=" + GetParam().function}), options_};
  ASSERT_TRUE(run.wait_for_err("arm       moves", kWithin)) << run.err();
  run.signal(SIGINT);
  const CommandResult result = run.finish(kWithin);
  EXPECT_FALSE(result.timed_out);
  EXPECT_EQ(result.exit_code, 1);
  const std::string hangs = "the " + GetParam().phase + " of 'beat' has not returned for ";
  EXPECT_THAT(result.err, HasSubstr("arm       at rest\n"));
  EXPECT_THAT(result.err, HasSubstr("armature: " + hangs));
  if (GetParam().function == "destructor") {
    EXPECT_THAT(result.out, HasSubstr(R"({"status":"ok")")) << "it was told before";
  } else {
    EXPECT_THAT(result.out, HasSubstr(R"({"status":"fault","reason":")" + hangs));
  }
  EXPECT_EQ(report(), result.out) << "one object, the same in both places";
}

INSTANTIATE_TEST_SUITE_P(In, PulledPlugOfAComponent,
                         testing::Values(Hang{"stop", "stop"}, Hang{"summarize", "summary"},
                                         Hang{"destructor", "destructor"}),
                         [](const auto& hang) { return hang.param.function; });

TEST_F(PulledPlug, FilesThatAreNeverWrittenAreNamedAndTheProcessLeavesAllTheSame) {
  Command run{command({"components.beat.params.hangs_in=write_files"}), options_};
  ASSERT_TRUE(run.wait_for_err("arm       moves", kWithin)) << run.err();
  run.signal(SIGINT);
  const CommandResult result = run.finish(kWithin);
  EXPECT_FALSE(result.timed_out);
  EXPECT_EQ(result.exit_code, 1);
  EXPECT_THAT(result.err, HasSubstr("armature: the report of 'beat' has not returned for "));
  EXPECT_EQ(report(), result.out) << "what was measured is there";
}

TEST_F(PulledPlug, AComponentOfAnotherProcessThatDoesNotEndIsNamedByTheMainOne) {
  Command run{command({"components.beat.process=aside", "components.beat.params.hangs_in=stop"}),
              options_};
  ASSERT_TRUE(run.wait_for_err("arm       moves", kWithin)) << run.err();
  const pid_t aside = run.child();
  run.signal(SIGINT);
  const CommandResult result = run.finish(kWithin);
  EXPECT_EQ(result.exit_code, 1);
  EXPECT_THAT(result.err, HasSubstr(kEndedAtRest));
  EXPECT_THAT(result.out, HasSubstr(R"({"status":"fault","reason":"process 'aside': the stop of )"
                                    "'beat' has not returned for "));
  EXPECT_TRUE(ends_within(aside, seconds{1}));
}

TEST_F(PulledPlug, ATransportThatDoesNotEndIsNamedAndTheProcessLeavesAllTheSame) {
  Command run{
      command(),
      {.environment = {{"ARMATURE_PLUGIN_PATH", std::string{DEAF_TRANSPORT} + ":" + TEST_PLUGINS},
                       {"DEAF_TRANSPORT_HANGS", "1"}},
       .input = {}}};
  ASSERT_TRUE(run.wait_for_err("arm       moves", kWithin)) << run.err();
  run.signal(SIGINT);
  const CommandResult result = run.finish(kWithin);
  EXPECT_FALSE(result.timed_out);
  EXPECT_EQ(result.exit_code, 1);
  EXPECT_THAT(result.err, HasSubstr("armature: the end of the transport has not returned for "));
}

TEST_F(PulledPlug, AProcessThatIsInterruptedWhileTheMainOneIsHaltedStopsByItself) {
  Command run{command({kApart}), options_};
  ASSERT_TRUE(run.wait_for_err("arm       moves", kWithin)) << run.err();
  const pid_t aside = run.child();
  run.signal(SIGSTOP);
  kill(aside, SIGINT);
  EXPECT_TRUE(run.wait_for_err(
      "runtime   stopping: interrupted; the main process does not answer, and this one ends by "
      "itself\n",
      kWithin))
      << run.err();
  EXPECT_TRUE(run.wait_for_err(kEndedAtRest, kWithin)) << run.err();
  EXPECT_TRUE(ends_within(aside, kWithin));
}

TEST_F(PulledPlug, SharedMemoryOfKilledProcessesIsGoneAtTheNextStart) {
  std::set<std::string> left;
  {
    Command run{command({kApart}), options_};
    ASSERT_TRUE(run.wait_for_err("arm       moves", kWithin)) << run.err();
    const pid_t aside = run.child();
    left = shared_memory_of(run.pid());
    left.merge(shared_memory_of(aside));
    kill(aside, SIGSTOP);  // so that neither tidies up
    run.signal(SIGKILL);
    kill(aside, SIGKILL);
    run.finish(kWithin);
    ASSERT_TRUE(ends_within(aside, kWithin));
  }
  ASSERT_FALSE(left.empty());
  Command next{command(), options_};
  ASSERT_TRUE(next.wait_for_err("arm       moves", kWithin)) << next.err();
  // Ports are of a domain, and it is the same one.
  std::erase_if(left, [](const auto& file) { return file.find("_port") != std::string::npos; });
  for (const std::string& file : left) EXPECT_FALSE(std::filesystem::exists(file)) << file;
  next.signal(SIGINT);
  next.finish(kWithin);
}

}  // namespace
}  // namespace armature::test
