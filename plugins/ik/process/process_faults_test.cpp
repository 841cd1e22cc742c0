// SPDX-License-Identifier: Apache-2.0
// Whatever a program does wrong is a reason, and the next goal is answered.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <thread>

#include "armature/kinds/declared_params.hpp"
#include "gantry_test.hpp"
#include "process.hpp"

namespace armature::ik::process {
namespace {

using Code = IkStatus::Code;

constexpr const char* kFolder = ARMATURE_SOURCE_DIR "/plugins/ik/process";

Expected<std::unique_ptr<IkSolver>> made(const RobotModel& model, const std::string& params) {
  return Process::make(model, declared_params(std::string{kFolder} + "/plugin.yaml", params));
}

/// The gantry and its program, at fault in the questions from `first` to `last` (make asks the
/// first of all). Generous with time, but for a fault that is waited for.
class Faulty {
 public:
  Faulty(const std::string& fault, int first, int last, const std::string& more = "timeout_s: 60") {
    auto solver = made(model_, fmt::format("{{command: [./faulty_program.py, {}, {}, {}], folder: "
                                           "{}, start_timeout_s: 60, {}}}",
                                           fault, first, last, kFolder, more));
    if (solver) {
      solver_ = std::move(*solver);
    } else {
      refusal_ = solver.error().text;
    }
  }

  const std::string& refusal() const { return refusal_; }
  IkStatus ask(double x) {
    IkState state;
    return ask(x, state);
  }
  IkStatus ask(double x, IkState& state) {
    return solver_->solve(at(x, 0.2, 0.3), JointVector::Zero(3), found_, state);
  }
  std::string reason(double x) { return describe(ask(x)); }
  const IkBranches& found() const { return found_; }

 private:
  RobotModel model_ = gantry();
  std::unique_ptr<IkSolver> solver_;
  std::string refusal_;
  IkBranches found_;
};

std::string program(const std::string& fault, int first, int last) {
  return fmt::format("the program './faulty_program.py {} {} {}' ", fault, first, last);
}

struct Fault {
  const char* name;
  const char* reason;
  const char* more = "timeout_s: 60";

  friend void PrintTo(const Fault& fault, std::ostream* out) { *out << fault.name; }
};

class FaultyProgram : public testing::TestWithParam<Fault> {};

TEST_P(FaultyProgram, IsEndedWithAReasonAndStartedAgainForTheNextGoal) {
  const auto& [name, reason, more] = GetParam();
  Faulty gantry{name, 2, 2, more};
  ASSERT_EQ(gantry.refusal(), "");
  EXPECT_EQ(gantry.reason(0.1), "no_convergence: " + program(name, 2, 2) + reason +
                                    "; it is started again for the next goal, 1 of 3 times in a "
                                    "row");
  EXPECT_EQ(gantry.found().count, 0);
  EXPECT_EQ(gantry.reason(0.1), "ok");
  ASSERT_EQ(gantry.found().count, 1);
  EXPECT_EQ(gantry.found().branch[0].q, (Eigen::Vector3d{0.3, 0.2, 0.1}));
}

constexpr const char* kBriefly = "timeout_s: 0.3";

INSTANTIATE_TEST_SUITE_P(
    Faults, FaultyProgram,
    testing::Values(
        Fault{"exits", "ended with exit code 1; its last words: it has had enough"},
        Fault{"crashes", "was killed by signal 11 (Segmentation fault)"},
        Fault{"closes", "closed its output"}, Fault{"half_a_line", "ended with exit code 0"},
        Fault{"sleeps", "gave no answer within 0.3 s", kBriefly},
        Fault{"garbage", "answers not JSON: 'Loading model...'"},
        Fault{"endless_line", "answers with more than 65536 bytes in a line"},
        Fault{"nan",
              "answers not JSON: '{\"id\": 2, \"status\": \"ok\", \"solutions\": [{\"joints\": "
              "[NaN, 0, ...'"},
        Fault{"few_joints",
              "answers with solution 1 of 1: 'joints' has 2 numbers, must have 3: '{\"id\": 2, "
              "\"status\": \"ok\", \"solutions\": [{\"joints\": [0, 0]}]}'"},
        Fault{"other_id",
              "answers question 1, and 2 was asked: '{\"id\": 1, \"status\": \"ok\", "
              "\"solutions\": [{\"label\": \"only\", \"j...'"}),
    [](const auto& test) { return std::string{test.param.name}; });

TEST(FaultyProgram, ThatNeverStopsTalkingToTheOperatorIsSlow) {
  testing::internal::CaptureStderr();
  {
    Faulty gantry{"endless_errors", 2, 2, kBriefly};
    const std::string reason = gantry.reason(0.1);
    EXPECT_TRUE(reason.starts_with("no_convergence: " + program("endless_errors", 2, 2) +
                                   "gave no answer within 0.3 s; its last words: xxx"))
        << reason;
    EXPECT_EQ(gantry.reason(0.1), "ok");
  }
  testing::internal::GetCapturedStderr();
}

TEST(FaultyProgram, ThatAnswersTwiceIsOutOfStepForTheNextGoal) {
  Faulty gantry{"twice", 2, 2};
  EXPECT_EQ(gantry.reason(0.1), "ok");
  EXPECT_NE(gantry.reason(0.2).find("answers question 2, and 3 was asked"), std::string::npos);
  EXPECT_EQ(gantry.reason(0.2), "ok");
}

TEST(FaultyProgram, ThatFailsEveryTimeIsLeftAloneAfterItsRestarts) {
  Faulty gantry{"exits", 2, 1000, "timeout_s: 60, max_restarts: 2"};
  const std::string says = "no_convergence: " + program("exits", 2, 1000) +
                           "ended with exit code 1; its last words: it has had enough; ";
  EXPECT_EQ(gantry.reason(0),
            says + "it is started again for the next goal, 1 of 2 times in a row");
  EXPECT_EQ(gantry.reason(0),
            says + "it is started again for the next goal, 2 of 2 times in a row");
  for (int i = 0; i < 3; ++i) {
    EXPECT_EQ(gantry.reason(0), says + "2 restarts in a row did not help, and it is left alone");
  }
  Faulty once{"exits", 2, 2, "timeout_s: 60, max_restarts: 0"};
  const std::string last = once.reason(0);
  EXPECT_TRUE(last.ends_with("; it is not started again, since max_restarts is 0")) << last;
  EXPECT_EQ(once.reason(0), last);
}

TEST(WrongAnswer, IsRefusedAndTheProgramGoesOn) {
  Faulty wrong{"wrong", 2, 2};
  const std::string reason = wrong.reason(0.1);
  EXPECT_TRUE(reason.starts_with("no_convergence: " + program("wrong", 2, 2) +
                                 "answers with solution 1 of 1, which misses the goal by 0.361 m "))
      << reason;
  EXPECT_EQ(wrong.found().count, 0);
  EXPECT_EQ(wrong.reason(0.1), "ok");
  Faulty nothing{"nothing_found", 2, 2};
  EXPECT_EQ(nothing.reason(0.1), "no_convergence: " + program("nothing_found", 2, 2) +
                                     "says 'ok' and tells no solution");
  EXPECT_EQ(nothing.reason(0.1), "ok");
}

TEST(WrongAnswer, BeyondTheLimitsIsKnownToBe) {
  Faulty gantry{"none", 0, 0};
  EXPECT_EQ(gantry.reason(2.5),
            "joint_limit: every solution of the program leaves the joint limits");
  ASSERT_EQ(gantry.found().count, 1);
  EXPECT_FALSE(gantry.found().branch[0].within_limits);
}

TEST(WrongAnswer, ThatCountsInItsLabelsIsRefusedInTime) {
  Faulty gantry{"many_labels", 2, 1000};
  int answered = 0;
  while (answered < 300 && gantry.ask(0.1).code == Code::ok) ++answered;
  EXPECT_LE(answered, 256);
  EXPECT_NE(gantry.reason(0.1).find("a label names a branch"), std::string::npos);
}

TEST(ARefusal, ComesThroughAsItIs) {
  Faulty gantry{"refuses", 2, 2};
  const IkStatus status = gantry.ask(0.1);
  EXPECT_EQ(status.code, Code::out_of_reach);
  EXPECT_EQ(status.shortfall, 0.25);
  EXPECT_EQ(status.detail, "the rail ends");
}

TEST(WhatAProgramRemembers, IsKeptByTheAskerAndSentAgain) {
  Faulty gantry{"counts", 2, 1000};
  IkState one, other;
  for (const double calls : {1, 2, 3}) {
    EXPECT_EQ(gantry.ask(0.1, one).code, Code::ok);
    EXPECT_EQ(one.last_redundancy, calls);
  }
  EXPECT_EQ(gantry.ask(0.1, other).code, Code::ok);
  EXPECT_EQ(other.last_redundancy, 1);
  Faulty forgetful{"none", 0, 0};
  EXPECT_EQ(forgetful.ask(0.1, one).code, Code::ok);
  EXPECT_EQ(one.last_redundancy, 3) << "what is not told is as it was";
  one.last_redundancy = NAN;
  EXPECT_EQ(describe(gantry.ask(0.1, one)), "invalid_input: the last redundancy is not finite");
}

TEST(AReason, StaysWhatItIsWhateverIsAskedNext) {
  Faulty gantry{"refuses_each", 2, 3};
  ASSERT_EQ(gantry.refusal(), "");
  const IkStatus first = gantry.ask(0.1);
  const std::string text{first.detail};
  const IkStatus second = gantry.ask(0.2);
  EXPECT_EQ(first.detail, text);
  EXPECT_NE(second.detail, text);
}

/// Ends the process with 0 when a reason behind 1024 others is not kept, and says so.
[[noreturn]] void ask_for_more_reasons_than_are_kept() {
  Faulty gantry{"refuses_each", 2, 2000};
  std::string_view last;
  for (int asked = 1; asked <= 1025; ++asked) last = gantry.ask(0.001 * asked).detail;
  std::exit(last == "a reason behind 1024 different ones: it is printed on standard error" ? 0 : 1);
}

TEST(AReasonDeathTest, BehindAThousandOthersIsPrinted) {  // they stay: so in a process of its own
  EXPECT_EXIT(ask_for_more_reasons_than_are_kept(), testing::ExitedWithCode(0),
              "refuses_each 2 2000\\): 1.025 is too far\n");
}

TEST(StandardError, IsPassedOnUnderTheProgramsName) {
  testing::internal::CaptureStderr();
  {
    Faulty gantry{"says_much", 2, 2};
    EXPECT_EQ(gantry.reason(0.1), "ok");
  }
  const std::string said = testing::internal::GetCapturedStderr();
  const std::string name = "ik/process (./faulty_program.py says_much 2 2): ";
  EXPECT_TRUE(said.starts_with(name + "working on it\n" + name + "not there yet\n" + name + "xxx"))
      << said.substr(0, 200);
  EXPECT_EQ(std::count(said.begin(), said.end(), 'x'), 300000) << "and nothing is lost";
}

TEST(SetUp, RefusesAProgramThatCannotBeStarted) {
  const RobotModel model = gantry();
  const auto refusal = [&](const std::string& params) {
    const auto solver = made(model, params);
    return solver ? "" : solver.error().text;
  };
  EXPECT_EQ(refusal("command: []"), "'command' is empty: it lists the program and its arguments");
  const std::string path = std::getenv("PATH");
  EXPECT_EQ(refusal("command: [armature-has-no-such-program]"),
            "there is no program 'armature-has-no-such-program' in PATH, which is " + path);
  EXPECT_EQ(refusal("{command: [./solver], folder: /nowhere}"), "there is no folder '/nowhere'");
  const std::string folder = std::string{", folder: "} + kFolder + "}";
  EXPECT_EQ(refusal("{command: [./solver]" + folder),
            std::string{"there is no '"} + kFolder + "/solver'");
  EXPECT_EQ(refusal("{command: [./README.md]" + folder),
            std::string{"'"} + kFolder + "/README.md' cannot be executed");
}

TEST(SetUp, RefusesAProgramThatDoesNotAnswer) {
  EXPECT_EQ((Faulty{"exits", 1, 1}.refusal()),
            program("exits", 1, 1) + "ended with exit code 1; its last words: it has had enough");
  EXPECT_EQ((Faulty{"garbage", 1, 1}.refusal()),
            program("garbage", 1, 1) + "answers not JSON: 'Loading model...'");
  const RobotModel model = gantry();
  const auto mute = made(model, "{command: [sleep, 3600], start_timeout_s: 0.1}");
  EXPECT_EQ(mute.error().text, "the program 'sleep 3600' gave no answer within 0.1 s");
}

TEST(ManyThreads, EachGetTheAnswerToTheirOwnGoal) {
  const RobotModel model = gantry();
  const auto solver =
      made(model, std::string{"{command: [./faulty_program.py, none, 0, 0], start_timeout_s: 60, "
                              "timeout_s: 60, folder: "} +
                      kFolder + "}");
  ASSERT_TRUE(solver) << solver.error().text;
  std::vector<std::jthread> threads;
  for (int t = 0; t < 8; ++t) {
    threads.emplace_back([&, t] {
      for (int i = 0; i < 50; ++i) {
        const double x = 0.1 * t + 0.001 * i;
        IkBranches found;
        IkState state;
        const IkStatus status = (*solver)->solve(at(x, 0, 0), JointVector::Zero(3), found, state);
        EXPECT_EQ(status.code, Code::ok) << describe(status);
        EXPECT_EQ(found.count == 1 ? found.branch[0].q[2] : -1, x);
      }
    });
  }
}

/// Processes that this one has started and not waited for.
std::vector<std::string> children() {
  std::vector<std::string> all;
  for (const auto& thread : std::filesystem::directory_iterator{"/proc/self/task"}) {
    std::ifstream file{thread.path() / "children"};
    for (std::string pid; file >> pid;) all.push_back(pid);
  }
  return all;
}

long open_files() {
  return std::distance(std::filesystem::directory_iterator{"/proc/self/fd"}, {});
}

TEST(ManyEnds, LeaveNoProcessAndNoOpenFile) {
  testing::internal::CaptureStderr();
  ASSERT_TRUE(children().empty());
  const long files = open_files();
  for (const char* fault : {"exits", "garbage", "twice"}) {
    Faulty gantry{fault, 2, 2};
    EXPECT_EQ(children().size(), 1U);
    gantry.ask(0.1);
    gantry.ask(0.1);
  }
  EXPECT_NE((Faulty{"exits", 1, 1}.refusal()), "");
  Faulty{"sleeps", 2, 2, kBriefly}.ask(0.1);
  EXPECT_TRUE(children().empty());
  EXPECT_EQ(open_files(), files);
  testing::internal::GetCapturedStderr();
}

}  // namespace
}  // namespace armature::ik::process
