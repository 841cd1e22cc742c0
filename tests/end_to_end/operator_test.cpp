// SPDX-License-Identifier: Apache-2.0
// An operator at a running deployment, by DDS: what he confirms begins, what he pauses rests, and
// what he aborts goes back.
#include <gmock/gmock.h>
#include <unistd.h>

#include <chrono>
#include <csignal>
#include <nlohmann/json.hpp>
#include <thread>

#include "armature/messages/armature_msgs.hpp"
#include "asker.hpp"
#include "command.hpp"
#include "tests/dds_domain.hpp"
#include "tests/terminal.hpp"

namespace armature::test {
namespace {

using testing::ContainsRegex, testing::HasSubstr, testing::Not;

constexpr std::chrono::seconds kAtMost{30};
constexpr int kRefused = 1, kUsage = 2, kInvalid = 3, kTimedOut = 5;

class OperatorTest : public testing::Test {
 protected:
  std::vector<std::string> biopsy(const std::string& verb) const {
    return {armature(), verb, source_file("configs/" + file_), "--domain", domain_};
  }
  std::vector<std::string> operated_biopsy() const {
    std::vector<std::string> command = biopsy("run");
    command.insert(command.begin() + 3, source_file("configs/overlays/operated.yaml"));
    return command;
  }
  CommandResult say(const std::string& word, std::vector<std::string> more = {}) const {
    std::vector<std::string> command = biopsy("operator");
    command.insert(command.end(), {"--say", word, "--timeout", "10"});
    command.insert(command.end(), more.begin(), more.end());
    return run_command(command, {}, kAtMost);
  }
  const std::string domain_ = std::to_string(unique_dds_domain());
  std::string file_ = "sr1_biopsy.yaml";
};

TEST_F(OperatorTest, ConfirmsPausesResumesAndAborts) {
  Command run{operated_biopsy(), {}};
  ASSERT_TRUE(run.wait_for_err("asks the operator to confirm 'approach'", kAtMost)) << run.err();
  const CommandResult early = say("confirm", {"--step", "insertion"});
  EXPECT_EQ(early.exit_code, kRefused);
  EXPECT_THAT(early.err, HasSubstr("'confirm' was refused: the step that waits for its "
                                   "confirmation is 'approach', not 'insertion'"));
  const CommandResult confirmed = say("confirm", {"--step", "approach", "--json"});
  EXPECT_EQ(confirmed.exit_code, 0) << confirmed.err;
  const auto told = nlohmann::json::parse(confirmed.out);
  EXPECT_EQ(told["state"], "approach");
  EXPECT_EQ(told["steps"][1]["state"], "active");
  EXPECT_EQ(told["steps"][2]["state"], "ahead");
  EXPECT_EQ(told["auto_confirm"], false);
  EXPECT_EQ(say("pause").exit_code, 0);
  EXPECT_TRUE(run.wait_for_err("paused: approach", kAtMost)) << run.err();
  EXPECT_EQ(say("resume").exit_code, 0);
  EXPECT_EQ(say("abort").exit_code, 0);
  EXPECT_TRUE(run.wait_for_err("task      aborted", kAtMost)) << run.err();
  const CommandResult ended = run.finish(kAtMost);
  EXPECT_EQ(ended.exit_code, 1) << "a run that was broken off has not met its goals";
  EXPECT_THAT(ended.out, HasSubstr("aborted"));
}

TEST_F(OperatorTest, ConfirmsATouchOnceTheTipRestsAndTakesItBack) {
  file_ = "sr1_touching.yaml";
  Command run{operated_biopsy(), {}};
  ASSERT_TRUE(run.wait_for_err("asks the operator to confirm 'marker 1'", kAtMost)) << run.err();
  const auto until = std::chrono::steady_clock::now() + kAtMost;
  CommandResult confirmed = say("confirm", {"--step", "marker 1"});
  while (confirmed.exit_code == kRefused && std::chrono::steady_clock::now() < until) {
    EXPECT_THAT(confirmed.err, HasSubstr("'confirm' was refused: the tip ")) << "the hand leads it";
    confirmed = say("confirm", {"--step", "marker 1"});
  }
  EXPECT_EQ(confirmed.exit_code, 0) << confirmed.err;
  EXPECT_TRUE(run.wait_for_err("asks the operator to confirm 'marker 2'", kAtMost)) << run.err();
  EXPECT_EQ(say("back").exit_code, 0);
  EXPECT_TRUE(run.wait_for_err("0 of 6 markers touched", kAtMost)) << run.err();
  EXPECT_EQ(say("abort").exit_code, 0);
  EXPECT_TRUE(run.wait_for_err("task      aborted", kAtMost)) << run.err();
  EXPECT_EQ(run.finish(kAtMost).exit_code, 1);
}

/// A program that writes what the biopsy's task tells, as the deployment that it says to be.
class ForgedTask {
 public:
  ForgedTask(int domain, const std::string& deployment)
      : transport_{std::move(*FastDdsTransport::make({.network = {.domain = domain},
                                                      .deployment = deployment,
                                                      .fingerprint = std::string(64, '0'),
                                                      .now = system_now}))},
        states_{message_type<msg::TaskState>(), 4},
        writer_{std::move(*transport_->advertise(
            {"rt/sr1_biopsy/task/state", &message_type<msg::TaskState>(), QosProfile::state}))},
        thread_{[this](const std::stop_token& ended) { tell(ended); }} {}

 private:
  void tell(const std::stop_token& ended) {
    while (!ended.stop_requested()) {
      SampleRef sample = states_.loan();
      auto& state = *static_cast<msg::TaskState*>(sample.mutable_message());
      state.state_() = "forged\x1b[31m";
      state.procedure_().resize(1);
      state.procedure_()[0].name_() = "forged";
      state.procedure_()[0].state_(1);  // waits for its confirmation
      sample.mutable_info().published = system_now();
      writer_->offer(sample);
      std::this_thread::sleep_for(std::chrono::milliseconds{10});
    }
  }

  std::unique_ptr<Transport> transport_;
  SamplePool states_;
  std::unique_ptr<RemoteWriter> writer_;
  std::jthread thread_;
};

TEST_F(OperatorTest, BelievesNobodyButTheDeploymentsOwnTask) {
  Command run{operated_biopsy(), {}};
  ASSERT_TRUE(run.wait_for_err("asks the operator to confirm 'approach'", kAtMost)) << run.err();
  const ForgedTask stranger{std::stoi(domain_), "stranger"};
  ASSERT_TRUE(run.wait_for_err("writes '/sr1_biopsy/task/state', too", kAtMost)) << run.err();
  const CommandResult confirmed = say("confirm", {"--step", "approach"});
  EXPECT_EQ(confirmed.exit_code, 0) << confirmed.err;
  EXPECT_THAT(confirmed.out, Not(HasSubstr("forged")));
  EXPECT_THAT(confirmed.err, ContainsRegex("a writer of deployment 'stranger'.* writes "
                                           "'/sr1_biopsy/task/state', too, and is no part of "
                                           "deployment 'sr1_biopsy': what it tells is not taken"));
  EXPECT_TRUE(run.wait_for_err("the operator says confirm approach", kAtMost)) << run.err();
}

TEST_F(OperatorTest, ConfirmsNothingWhereTwoSayThatTheyAreTheTask) {
  Command run{operated_biopsy(), {}};
  ASSERT_TRUE(run.wait_for_err("asks the operator to confirm 'approach'", kAtMost)) << run.err();
  const ForgedTask second{std::stoi(domain_), "sr1_biopsy"};
  ASSERT_TRUE(run.wait_for_err("writes '/sr1_biopsy/task/state', too", kAtMost)) << run.err();
  const CommandResult confirmed = say("confirm", {"--step", "approach"});
  EXPECT_EQ(confirmed.exit_code, kRefused);
  EXPECT_THAT(confirmed.err, HasSubstr("2 writers say that they are the task of deployment "
                                       "'sr1_biopsy'"));
  EXPECT_THAT(confirmed.err, HasSubstr("pid " + std::to_string(run.pid())));
  EXPECT_THAT(confirmed.err, HasSubstr("pid " + std::to_string(getpid())));
  EXPECT_THAT(run.err(), Not(HasSubstr("the operator says")));
}

TEST_F(OperatorTest, IsToldThatTheArmIsStoppedWhereAWordWouldDoNothing) {
  Command run{operated_biopsy(), {}};
  ASSERT_TRUE(run.wait_for_err("asks the operator to confirm 'approach'", kAtMost)) << run.err();
  EXPECT_EQ(say("confirm", {"--step", "approach"}).exit_code, 0);
  const CommandResult stopped = run_command({armature(), "stop", "--domain", domain_}, {}, kAtMost);
  ASSERT_EQ(stopped.exit_code, 0) << stopped.err;
  ASSERT_TRUE(run.wait_for_err("task      held: ", kAtMost)) << run.err();
  for (const char* word : {"abort", "back"}) {
    const CommandResult said = say(word);
    EXPECT_EQ(said.exit_code, kRefused) << word;
    EXPECT_EQ(said.err, std::string{"armature: '"} + word +
                            "' was refused: the arm is stopped: rearm it first\n");
  }
  EXPECT_THAT(run.err(), Not(HasSubstr("task      aborting")));
}

TEST_F(OperatorTest, TypesHisWords) {
  Command run{operated_biopsy(), {}};
  ASSERT_TRUE(run.wait_for_err("asks the operator to confirm 'approach'", kAtMost)) << run.err();
  const CommandResult dialogue =
      run_command(biopsy("operator"), {.environment = {}, .input = "go\nc\nb\n"}, kAtMost);
  EXPECT_EQ(dialogue.exit_code, kUsage) << "as of --say go";
  EXPECT_THAT(dialogue.out, HasSubstr("approach      waits for confirm"));
  EXPECT_THAT(dialogue.err, HasSubstr("'go' is no word of an operator"));
  EXPECT_TRUE(run.wait_for_err("the operator says confirm approach", kAtMost)) << run.err();
  EXPECT_TRUE(run.wait_for_err("the operator says back", kAtMost)) << run.err();
  EXPECT_FALSE(ends_within(run.pid(), std::chrono::seconds{0}))
      << "the end of the input ends the dialogue, not the run";
}

TEST_F(OperatorTest, IsHeardWhereTheLastLineOfAFileHasNoEndAndBlanksStandAroundItsWord) {
  Command run{operated_biopsy(), {}};
  ASSERT_TRUE(run.wait_for_err("asks the operator to confirm 'approach'", kAtMost)) << run.err();
  const CommandResult dialogue =
      run_command(biopsy("operator"), {.environment = {}, .input = " abort\r"}, kAtMost);
  EXPECT_EQ(dialogue.exit_code, 0) << dialogue.err;
  EXPECT_TRUE(run.wait_for_err("the operator says abort", kAtMost)) << run.err();
  EXPECT_EQ(run.finish(kAtMost).exit_code, 1) << "it was broken off";
}

TEST_F(OperatorTest, OfAFileTheExitCodeIsTheWorstOfItsWords) {
  Command run{operated_biopsy(), {}};
  ASSERT_TRUE(run.wait_for_err("asks the operator to confirm 'approach'", kAtMost)) << run.err();
  const CommandResult dialogue =
      run_command(biopsy("operator"), {.environment = {}, .input = "resume\npause\n"}, kAtMost);
  EXPECT_EQ(dialogue.exit_code, kRefused);
  EXPECT_THAT(dialogue.err, HasSubstr("'resume' was refused"));
  EXPECT_TRUE(run.wait_for_err("the operator says pause", kAtMost)) << run.err();
}

TEST_F(OperatorTest, AtATerminalNothingIsSaidWithoutEnterAndARefusalWasSeen) {
  Command run{operated_biopsy(), {}};
  ASSERT_TRUE(run.wait_for_err("asks the operator to confirm 'approach'", kAtMost)) << run.err();
  Terminal dialogue{biopsy("operator")};
  ASSERT_TRUE(dialogue.shows("c(onfirm) 'approach'"));
  dialogue.type("resume\n");
  ASSERT_TRUE(dialogue.shows("'resume' was refused"));
  dialogue.type("abort\x04\x04\x04");  // the end of the input, by Control and D
  EXPECT_EQ(dialogue.exit_code(), 0);
  EXPECT_THAT(run.err(), Not(HasSubstr("the operator says abort")));
}

TEST_F(OperatorTest, IsToldThatTheTaskWhoseQuestionStandsThereIsGone) {
  Command run{operated_biopsy(), {}};
  ASSERT_TRUE(run.wait_for_err("asks the operator to confirm 'approach'", kAtMost)) << run.err();
  Terminal dialogue{biopsy("operator")};
  ASSERT_TRUE(dialogue.shows("c(onfirm) 'approach'"));
  run.signal(SIGKILL);
  EXPECT_TRUE(dialogue.shows("the task of 'sr1_biopsy' is gone"));
  dialogue.type("abort\n");
  EXPECT_TRUE(dialogue.shows("the task is gone, and nobody has heard 'abort'"));
  Command next{operated_biopsy(), {}};
  EXPECT_TRUE(dialogue.shows("c(onfirm) 'approach'"));
  EXPECT_THAT(next.err(), Not(HasSubstr("the operator says abort")));
}

TEST_F(OperatorTest, WhoWasHaltedMeetsTheTaskAnewAndIsHeard) {
  Command run{operated_biopsy(), {}};
  ASSERT_TRUE(run.wait_for_err("asks the operator to confirm 'approach'", kAtMost)) << run.err();
  Terminal dialogue{biopsy("operator")};
  ASSERT_TRUE(dialogue.shows("c(onfirm) 'approach'"));
  dialogue.signal(SIGSTOP);
  std::this_thread::sleep_for(std::chrono::milliseconds{1500});
  dialogue.signal(SIGCONT);
  ASSERT_TRUE(dialogue.shows("s; it meets the task anew"));
  ASSERT_TRUE(dialogue.shows("c(onfirm) 'approach'")) << "the screen says again what waits";
  dialogue.type("abort\n");
  EXPECT_TRUE(run.wait_for_err("the operator says abort", kAtMost)) << run.err();
}

TEST_F(OperatorTest, WhereNothingRunsHeIsToldSo) {
  std::vector<std::string> command = biopsy("operator");
  command.insert(command.end(), {"--say", "abort", "--timeout", "0.5"});
  const CommandResult result = run_command(command, {}, kAtMost);
  EXPECT_EQ(result.exit_code, kTimedOut);
  EXPECT_THAT(result.err,
              HasSubstr("no task of 'sr1_biopsy' tells what it does in domain " + domain_));
}

TEST_F(OperatorTest, WhoIsInterruptedBeforeHisWordWasSaidIsToldSo) {
  std::vector<std::string> command = biopsy("operator");
  command.insert(command.end(), {"--timeout", "20"});
  std::vector<std::string> with_word = command;
  with_word.insert(with_word.end(), {"--say", "abort"});
  Command one_word{with_word}, script{command, {.environment = {}, .input = "abort\n"}};
  std::this_thread::sleep_for(std::chrono::seconds{2});  // they look for the task
  one_word.signal(SIGTERM);
  script.signal(SIGTERM);
  const CommandResult of_word = one_word.finish(kAtMost), of_script = script.finish(kAtMost);
  EXPECT_EQ(of_word.exit_code, kRefused);
  EXPECT_EQ(of_word.err, "armature: interrupted before 'abort' was said\n");
  EXPECT_EQ(of_script.exit_code, kRefused);
  EXPECT_EQ(of_script.err, "armature: interrupted before a word was said\n");
}

TEST_F(OperatorTest, AStepThatIsNoTextIsRefusedBeforeAnybodyHearsIt) {
  const CommandResult result = say("confirm", {"--step", "Eintritt \xFC"});
  EXPECT_EQ(result.exit_code, kUsage);
  EXPECT_THAT(result.err, HasSubstr("'Eintritt \\xfc' is not UTF-8, as text on topics is"));
}

TEST_F(OperatorTest, AComponentThatIsNoTaskIsNamed) {
  std::vector<std::string> command = biopsy("operator");
  command.insert(command.end(), {"--component", "motion"});
  const CommandResult result = run_command(command, {}, kAtMost);
  EXPECT_EQ(result.exit_code, kInvalid);
  EXPECT_THAT(result.err, HasSubstr("has no component 'motion' that hears an operator"));
}

}  // namespace
}  // namespace armature::test
