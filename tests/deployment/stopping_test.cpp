// SPDX-License-Identifier: Apache-2.0
// Whatever ends a run: what moves is at rest before anything ends, or is named.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <map>
#include <mutex>

#include "armature/config/document.hpp"
#include "armature/runtime/deployment/deployment.hpp"
#include "armature/runtime/reporting/run_report.hpp"

namespace armature {
namespace {

using testing::ElementsAre;
using testing::IsEmpty;

/// Stops the run when it is asked for the n-th time.
class StopWatch final : public RunWatch {
 public:
  explicit StopWatch(int asks = 1) : asks_left_{asks} {}
  std::optional<std::string> stop_cause() override {
    if (--asks_left_ > 0) return std::nullopt;
    return "enough";
  }
  void stopping(const std::string& cause, bool) override { causes.push_back(cause); }

  std::vector<std::string> causes;

 private:
  int asks_left_;
};

struct Halted {
  std::string status;
  std::vector<std::string> reasons, causes, said;
  std::map<std::string, std::string> texts;
  double ended_s = 0;
};

class Stopping : public testing::TestWithParam<const char*> {
 protected:
  Halted run(const std::string& components, StopWatch watch = StopWatch{1000000},
             const std::string& more = "") {
    config::Problems problems;
    auto config = read_deployment(
        config::parse_text(std::string{"armature: 1\nname: halt\nclock: "} + GetParam() + "\n" +
                               more + "components:\n" + components,
                           "test.yaml"),
        plugins_, problems);
    problems.throw_if_any();
    Halted run;
    std::mutex mutex;
    Deployment deployment{std::move(config),
                          plugins_,
                          {.process = "main", .on_line = [&](const auto& who, const auto& text) {
                             const std::scoped_lock lock{mutex};
                             run.said.push_back(std::string{who} + " " + std::string{text});
                           }}};
    const Time start = deployment.clock().now();
    deployment.run(watch);
    run.ended_s = to_seconds(deployment.clock().now() - start);
    const RunReport report{deployment, {}};
    run.status = report.status();
    run.reasons = report.reasons();
    run.causes = watch.causes;
    for (const auto& figure : report.figures()) {
      if (const auto* text = std::get_if<std::string>(&figure.value)) run.texts[figure.key] = *text;
    }
    return run;
  }

  PluginRegistry plugins_{{ARMATURE_TEST_PLUGINS}};
};

const std::vector<std::string> kAtRest{"arm moves", "arm stops", "arm at rest",
                                       "arm ended at rest"};

TEST_P(Stopping, AfterAStopFromOutsideItGoesOnUntilWhatMovesIsAtRest) {
  const Halted halted = run("  arm: {plugin: test/mover}\n", StopWatch{5});
  EXPECT_THAT(halted.causes, ElementsAre("enough"));
  EXPECT_EQ(halted.said, kAtRest);
  EXPECT_EQ(halted.status, "ok");
  EXPECT_GE(halted.ended_s, 0.3);
}

TEST_P(Stopping, OnTheSystemClockItGoesOnLongEnoughForOthersToHearThatItRests) {
  if (std::string{GetParam()} != "system") GTEST_SKIP() << "nobody hears it there";
  const Halted halted =
      run("  arm: {plugin: test/mover, params: {rest_after_s: 0}}\n", StopWatch{1});
  EXPECT_GE(halted.ended_s, 0.05);
  EXPECT_EQ(halted.said.back(), "arm ended at rest");
}

TEST_P(Stopping, SoItDoesAtTheTimeLimit) {
  const Halted halted =
      run("  arm: {plugin: test/mover}\n", StopWatch{1000000}, "run: {time_limit_s: 0.1}\n");
  EXPECT_THAT(halted.causes, ElementsAre("the time limit of 0.1 s is over"));
  EXPECT_EQ(halted.said, kAtRest);
}

TEST_P(Stopping, SoItDoesAtTheEndOfTheStoryWhoseTellerIsNotSteppedAnyMore) {
  const Halted halted = run(
      "  arm: {plugin: test/mover}\n"
      "  teller: {plugin: test/mover, topics: t, params: {ends_after_s: 0.05, rest_after_s: 0}}\n");
  EXPECT_THAT(halted.causes, ElementsAre("the scenario is over"));
  EXPECT_THAT(halted.said, testing::IsSupersetOf(kAtRest));
  EXPECT_EQ(halted.texts.at("arm.steps_after"), "0");
}

TEST_P(Stopping, SoItDoesAfterAFault) {
  const Halted halted =
      run("  arm: {plugin: test/mover}\n"
          "  beat: {plugin: test/beat, on_fault: stop, params: {throws_in: step}}\n");
  EXPECT_THAT(halted.causes, ElementsAre("beat: step failed: out of breath"));
  EXPECT_THAT(halted.said, testing::IsSupersetOf({"arm at rest", "arm ended at rest"}));
  EXPECT_EQ(halted.status, "fault");
}

TEST_P(Stopping, WhatDoesNotComeToRestInTimeIsNamedAndTheStatusSaysSo) {
  const Halted halted = run("  arm: {plugin: test/mover, params: {rest_after_s: 1000}}\n",
                            StopWatch{5}, "run: {stop_within_s: 0.2}\n");
  EXPECT_EQ(halted.status, "fault");
  EXPECT_THAT(halted.reasons, ElementsAre("'arm' was not at rest 0.2 s after it was to stop"));
  EXPECT_EQ(halted.said.back(), "arm ended while it moved");
}

TEST_P(Stopping, WhatMovesNothingNeedsNoStepToEnd) {
  const Halted halted = run("  beat: {plugin: test/beat}\n", StopWatch{5});
  EXPECT_EQ(halted.status, "ok");
  EXPECT_THAT(halted.reasons, IsEmpty());
}

INSTANTIATE_TEST_SUITE_P(OnBothClocks, Stopping, testing::Values("system", "simulated"),
                         [](const auto& clock) { return std::string{clock.param}; });

using StoppingInLockstep = Stopping;

TEST_P(StoppingInLockstep, WhatRestsAlreadyEndsTheRunInTheSameInstant) {
  const Halted halted =
      run("  arm: {plugin: test/mover, params: {ends_after_s: 0.05, rest_after_s: 0}}\n");
  EXPECT_DOUBLE_EQ(halted.ended_s, 0.05);
  EXPECT_EQ(halted.texts.at("steps_to_rest"), "0");
}

TEST_P(StoppingInLockstep, TheTimeToRestIsSimulated) {
  const Halted halted = run("  arm: {plugin: test/mover, params: {rest_after_s: 1000}}\n",
                            StopWatch{5}, "run: {stop_within_s: 2000}\n");
  EXPECT_EQ(halted.status, "ok");
  EXPECT_GE(halted.ended_s, 1000);
}

INSTANTIATE_TEST_SUITE_P(Simulated, StoppingInLockstep, testing::Values("simulated"),
                         [](const auto& clock) { return std::string{clock.param}; });

TEST(StoppingConfig, ATimeToStopThatIsNegativeIsRefused) {
  const PluginRegistry plugins{{ARMATURE_TEST_PLUGINS}};
  config::Problems problems;
  read_deployment(config::parse_text("armature: 1\nname: halt\nrun: {stop_within_s: -1}\n"
                                     "components: {beat: {plugin: test/beat}}\n",
                                     "test.yaml"),
                  plugins, problems);
  ASSERT_FALSE(problems.empty());
  EXPECT_EQ(problems.sorted().front().message,
            "'stop_within_s' is -1, must be from 0.1 to 3600: what moves comes to rest before "
            "anything ends");
}

}  // namespace
}  // namespace armature
