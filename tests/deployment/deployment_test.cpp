// SPDX-License-Identifier: Apache-2.0
// What a deployment file says of its components comes true when it runs: read, constructed and run
// on the simulated clock in this process.
#include "armature/runtime/deployment/deployment.hpp"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cfenv>
#include <nlohmann/json.hpp>

#include "armature/config/document.hpp"
#include "armature/runtime/reporting/run_report.hpp"

namespace armature {
namespace {

/// What a run has told.
struct Told {
  std::string status;
  std::vector<std::string> reasons;
  std::map<std::string, double> metrics;
  std::map<std::string, std::string> texts;
  std::string json, table;
};

class DeploymentTest : public testing::Test {
 protected:
  DeploymentConfig read(const std::string& text) {
    config::Problems problems;
    auto config = read_deployment(config::parse_text(text, "test.yaml"), plugins_, problems);
    problems.throw_if_any();
    return config;
  }

  /// `beat` and `ear` are added to what is said of the two components.
  Told run(const std::string& beat, const std::string& ear, const std::string& more = "",
           bool tells_timing = false) {
    Deployment deployment{read("armature: 1\nname: pulse\nclock: simulated\n" + more +
                               "components:\n"
                               "  beat: {plugin: test/beat" +
                               beat +
                               "}\n"
                               "  ear: {plugin: test/ear" +
                               ear + "}\n"),
                          plugins_,
                          {.process = "main"}};
    RunWatch alone;
    deployment.run(alone);
    RunReport::Ending ending;
    if (tells_timing) ending.timing = timing_of(deployment);
    const RunReport report{deployment, ending};
    Told told{.status = report.status(),
              .reasons = report.reasons(),
              .json = to_json(report),
              .table = to_table(
                  report, [](std::string_view word, bool) { return std::string{word}; },
                  [](std::string_view text) { return fmt::format("<{}>", text); })};
    for (const auto& figure : report.figures()) {
      if (const auto* value = std::get_if<double>(&figure.value)) told.metrics[figure.key] = *value;
      if (const auto* text = std::get_if<std::string>(&figure.value)) {
        told.texts[figure.key] = *text;
      }
    }
    return told;
  }

  PluginRegistry plugins_{{ARMATURE_TEST_PLUGINS}};
};

TEST_F(DeploymentTest, ASimulatedLatencyShiftsWhatAComponentSends) {
  EXPECT_DOUBLE_EQ(run("", "").metrics.at("delay_s"), 0);
  EXPECT_DOUBLE_EQ(run(", sim_latency_s: 0.004", "").metrics.at("delay_s"), 0.004);
  EXPECT_DOUBLE_EQ(run(", sim_latency_s: 0.025", "").metrics.at("delay_s"), 0.025);
  EXPECT_DOUBLE_EQ(run("", ", sim_latency_s: 0.004").metrics.at("delay_s"), 0);
}

TEST_F(DeploymentTest, ASampleThatIsTooOldForAPortIsNotShownThere) {
  const Told told = run(", params: {beats: 1}", "");
  EXPECT_DOUBLE_EQ(told.metrics.at("oldest_s"), 0.2);
  EXPECT_DOUBLE_EQ(told.metrics.at("oldest_young_s"), 0.05);
}

TEST_F(DeploymentTest, TheRuntimeTellsOfEveryComponentAndOfItself) {
  EXPECT_EQ(run("", "").texts.at("told_of"), "beat ear runtime runtime_clock runtime_log ");
}

TEST_F(DeploymentTest, HowLateAndHowLongStepsWereIsToldWhenAskedFor) {
  const Told told = run("", "", "", true);
  const auto timing = nlohmann::json::parse(told.json)["timing"];
  EXPECT_TRUE(timing["executors"].empty()) << "there are none in lockstep";
  const auto& beat = timing["components"]["beat"];
  EXPECT_GT(beat["step"]["count"], 10);
  EXPECT_EQ(beat["step"]["count"], beat["lateness"]["count"]);
  EXPECT_EQ(beat["lateness"]["max_s"], 0) << "in lockstep nothing is late";
  EXPECT_GT(beat["step"]["p99_s"], 0);
  EXPECT_LE(beat["step"]["p99_s"], beat["step"]["max_s"]);
  EXPECT_NE(told.table.find("  component [us] "), std::string::npos) << told.table;
  EXPECT_EQ(run("", "").json.find("timing"), std::string::npos) << "no two runs would be alike";
}

TEST_F(DeploymentTest, AGoalIsMetMissedOrWasNeverMeasured) {
  EXPECT_EQ(run("", "", "goals: {delay_s: 0.001}\n").status, "ok");
  const Told missed = run(", sim_latency_s: 0.004", "", "goals: {delay_s: 0.001}\n");
  EXPECT_EQ(missed.status, "goals_missed");
  EXPECT_EQ(missed.reasons,
            (std::vector<std::string>{"delay_s is 0.004, the goal is at most 0.001"}));
  const Told deaf = run(", sim_latency_s: 1", "", "goals: {delay_s: 0.001}\n");
  EXPECT_EQ(deaf.status, "goals_missed");
  EXPECT_EQ(deaf.reasons, (std::vector<std::string>{"delay_s was never measured"}));
}

TEST_F(DeploymentTest, SeveralNumbersAreAnArrayInJsonAndAListInTheTable) {
  const Told told = run(", sim_latency_s: 0.004, params: {beats: 2}", "");
  EXPECT_NE(told.json.find(R"("delays_s":[0.004,0.004])"), std::string::npos) << told.json;
  EXPECT_NE(told.table.find("delay of each beat [s]               0.004, 0.004\n"),
            std::string::npos)
      << told.table;
}

TEST_F(DeploymentTest, WhatCannotBeMeasuredSaysWhyAndDoesNotMeetItsGoal) {
  const Told deaf =
      run(", sim_latency_s: 1", ", params: {minds_silence: true}", "goals: {delay_s: 0.001}\n");
  EXPECT_EQ(deaf.reasons,
            (std::vector<std::string>{"delay_s was not measured: no beat was heard"}));
  EXPECT_NE(deaf.json.find(R"("not_measured":{"delay_s":"no beat was heard"})"), std::string::npos)
      << deaf.json;
  EXPECT_NE(deaf.table.find("-   goal 0.001  MISSED   not measured: <no beat was heard>\n"),
            std::string::npos)
      << deaf.table;
}

TEST_F(DeploymentTest, AGoalOfAFigureThatDoesNotApplyDecidesNothing) {
  const Told silent =
      run(", sim_latency_s: 1", ", params: {expects_silence: true}", "goals: {delay_s: 0.001}\n");
  EXPECT_EQ(silent.status, "ok");
  EXPECT_TRUE(silent.reasons.empty());
  EXPECT_NE(silent.json.find(R"("delay_s":null)"), std::string::npos) << silent.json;
  EXPECT_NE(silent.json.find(R"("does_not_apply":{"delay_s":"no beat was to come"})"),
            std::string::npos)
      << silent.json;
  EXPECT_NE(silent.table.find("-   goal 0.001   does not apply: <no beat was to come>\n"),
            std::string::npos)
      << silent.table;
}

TEST_F(DeploymentTest, FiguresThatTwoComponentsTellBearTheirNames) {
  const Told told =
      run(", sim_latency_s: 0.004", "}\n  late: {plugin: test/ear, params: {listens_s: 0.05}",
          "goals: {delay_s: 0.003}\n");
  EXPECT_DOUBLE_EQ(told.metrics.at("ear.delay_s"), 0.004);
  EXPECT_DOUBLE_EQ(told.metrics.at("late.delay_s"), 0.004);
  EXPECT_FALSE(told.metrics.contains("delay_s"));
  EXPECT_EQ(told.reasons,
            (std::vector<std::string>{"ear.delay_s is 0.004, the goal is at most 0.003",
                                      "late.delay_s is 0.004, the goal is at most 0.003"}));
  EXPECT_NE(told.json.find(R"("ear.delay_s":0.004)"), std::string::npos) << told.json;
  EXPECT_NE(told.json.find(R"("late.delay_s":0.004)"), std::string::npos) << told.json;
  EXPECT_NE(told.table.find("  late: delay [s]"), std::string::npos) << told.table;
}

TEST_F(DeploymentTest, AStoryThatFailedTellsItsReason) {
  const Told deaf = run(", sim_latency_s: 1", ", params: {minds_silence: true}");
  EXPECT_TRUE(deaf.json.starts_with(R"({"status":"deaf","reason":"beat tells nothing",)"))
      << deaf.json;
  EXPECT_NE(deaf.table.find("deaf\n    <beat tells nothing>\n"), std::string::npos) << deaf.table;
  EXPECT_EQ(run("", "").json.find("reason"), std::string::npos);
}

TEST_F(DeploymentTest, WhoIsUnwellAtTheEndIsToldAndIsTheStatusWhereNoGoalsJudge) {
  const std::string three = ", params: {beats: 3}", limit = "run: {time_limit_s: 0.3}\n";
  const std::string longer = ", params: {needs_beats: true, listens_s: 1}";
  const std::string shorter = ", params: {needs_beats: true, listens_s: 0.3}";
  const Told unjudged = run(three, longer, limit);
  EXPECT_EQ(unjudged.status, "degraded");
  EXPECT_NE(unjudged.json.find(R"("reason":"ear: no young beat")"), std::string::npos)
      << unjudged.json;
  EXPECT_NE(unjudged.json.find(R"("unwell":["ear: no young beat"])"), std::string::npos);
  EXPECT_NE(unjudged.table.find("unwell: <ear: no young beat>"), std::string::npos)
      << unjudged.table;

  const Told finished = run(three, shorter);
  EXPECT_EQ(finished.status, "ok") << "a scenario that came to its end is judged by itself";
  EXPECT_NE(finished.table.find("unwell: <ear: no young beat>"), std::string::npos);
  EXPECT_EQ(run(three, shorter, "goals: {delay_s: 1}\n").status, "ok");

  const Told well = run("", longer, limit);
  EXPECT_EQ(well.status, "ok");
  EXPECT_EQ(well.json.find("unwell"), std::string::npos) << "it was, before the first beat only";
}

TEST_F(DeploymentTest, AMetricThatItsPluginDoesNotDeclareIsAFaultThatNamesIt) {
  const Told told = run("", ", params: {undeclared: true}");
  EXPECT_EQ(told.status, "fault");
  EXPECT_EQ(
      told.reasons,
      (std::vector<std::string>{
          "ear: plugin 'test/ear' reports the metric 'surprise_s', which its plugin.yaml does "
          "not declare under 'measures:'"}));
}

TEST_F(DeploymentTest, AMetricThatIsNotFiniteIsAFaultWithAndWithoutAGoal) {
  const std::string defect =
      "ear: plugin 'test/ear' reports the metric 'oldest_order_s', which is not finite; what was "
      "not measured is told with its reason, by Summary::not_measured()";
  const Told told = run("", ", params: {reports_nan: true}");
  EXPECT_EQ(told.status, "fault");
  EXPECT_EQ(told.reasons, std::vector<std::string>{defect});
  const Told judged = run("", ", params: {reports_nan: true}", "goals: {oldest_order_s: 1}\n");
  EXPECT_EQ(judged.reasons, (std::vector<std::string>{defect, "oldest_order_s is not finite"}));
}

TEST_F(DeploymentTest, AMetricBelow0WhosePluginDoesNotSaySoIsAFaultAndMeetsNoGoalUnseen) {
  const Told told = run("", ", params: {reports_debts: true}", "goals: {orders_again: 1}\n");
  EXPECT_EQ(told.status, "fault");
  EXPECT_EQ(told.reasons,
            std::vector<std::string>{
                "ear: plugin 'test/ear' reports the metric 'orders_again', which is -3, and its "
                "plugin.yaml does not say that it may be below 0 (signed: true): every goal would "
                "be met"});
}

TEST_F(DeploymentTest, AStoryThatFailedWithoutAWordHasFailed) {
  const Told told = run(", params: {fails: true}", "");
  EXPECT_EQ(told.status, "failed");
  EXPECT_TRUE(told.json.starts_with(R"({"status":"failed","reason":"the heart stood still",)"));
}

TEST_F(DeploymentTest, WhatIsPublishedInAConstructorIsRefusedSinceNobodyWouldHearIt) {
  try {
    run(", params: {beats_when_made: true}", "");
    FAIL();
  } catch (const config::ConfigError& error) {
    EXPECT_STREQ(error.what(),
                 "test.yaml:5:3: component 'beat': it publishes 'beat' in its constructor, where "
                 "nobody hears it; publish in the first step");
  }
}

TEST_F(DeploymentTest, AComponentThatRoundsOtherwiseDoesSoAloneOnItsThread) {
  run(", params: {takes: rounding}", "");
  EXPECT_EQ(std::fegetround(), FE_TONEAREST);
}

TEST_F(DeploymentTest, WhatCutARunOffIsToldInTableAndJson) {
  const Told cut = run("", ", params: {listens_s: 1}", "run: {time_limit_s: 0.25}\n");
  EXPECT_EQ(cut.status, "ok") << "nothing says that it was to do more";
  EXPECT_NE(cut.json.find(R"("ended_by":"the time limit of 0.25 s is over")"), std::string::npos)
      << cut.json;
  EXPECT_NE(cut.table.find("<the time limit of 0.25 s is over>\n"), std::string::npos) << cut.table;
  EXPECT_EQ(run("", "").json.find("ended_by"), std::string::npos) << "it came to its end";
}

TEST_F(DeploymentTest, WhatAComponentThrowsIsAFaultThatNamesItAndTheOthersFiguresAreKept) {
  for (const std::string place : {"step", "stop", "summarize"}) {
    const Told told = run(", params: {throws_in: " + place + "}", "");
    EXPECT_EQ(told.status, "fault");
    EXPECT_EQ(told.reasons,
              (std::vector<std::string>{"beat: " + place + " failed: out of breath"}));
    EXPECT_EQ(told.metrics.count("oldest_s"), 1U) << place;
  }
  EXPECT_EQ(
      run(", params: {throws_in: step, throws_number: true}", "").reasons,
      (std::vector<std::string>{"beat: step failed: an exception that is no std::exception"}));
  EXPECT_EQ(run(", params: {throws_in: step, throws_silently: true}", "").reasons,
            (std::vector<std::string>{
                "beat: step failed: an exception without a text, std::runtime_error"}));
}

TEST_F(DeploymentTest, AComponentThatFailsInItsConstructorIsNamedWithItsPlaceInTheFile) {
  const auto refusal = [this](const std::string& params) -> std::string {
    try {
      run(", params: {throws_in: construction" + params + "}", "");
    } catch (const config::ConfigError& error) {
      return error.what();
    }
    return "nothing";
  };
  EXPECT_EQ(refusal(""), "test.yaml:5:3: component 'beat': out of breath");
  EXPECT_EQ(refusal(", throws_number: true"),
            "test.yaml:5:3: component 'beat': an exception that is no std::exception");
}

TEST_F(DeploymentTest, AParameterThatMustBeAnothersIsTakenFromItOrTheSame) {
  const auto beats_of_ear = [&](const std::string& components) {
    try {
      const auto config = read("armature: 1\nname: pulse\ncomponents:\n" + components);
      return std::to_string(config.components.back().params.integer("beats"));
    } catch (const config::ConfigError& error) {
      return std::string{error.what()};
    }
  };
  const std::string beat = "  beat: {plugin: test/beat, params: {beats: 3}}\n";
  EXPECT_EQ(beats_of_ear(beat + "  ear: {plugin: test/ear}\n"), "3");
  EXPECT_EQ(beats_of_ear(beat + "  ear: {plugin: test/ear, params: {beats: 3}}\n"), "3");
  EXPECT_EQ(beats_of_ear("  beat: {plugin: test/beat}\n"
                         "  ear: {plugin: test/ear, params: {beats: 3}}\n"),
            "test.yaml:5:43: 'beats' of component 'ear' must be the same as that of component "
            "'beat', and is not; leave one of them out, or make them equal");
  EXPECT_EQ(beats_of_ear(beat + "  late: {plugin: test/beat, topics: late, params: {beats: 4}}\n"
                                "  ear: {plugin: test/ear}\n"),
            "3")
      << "the one that it hears";
}

TEST_F(DeploymentTest, AnExecutorIsReadWithWhatItAsksOfTheSystem) {
  const auto config = read(
      "armature: 1\nname: pulse\nexecutors: {control: {period_s: 0.002, priority: 20, cpu: 0, "
      "lock_memory: "
      "true}}\n"
      "components: {beat: {plugin: test/beat, executor: control}}\n");
  ASSERT_EQ(config.executors.size(), 2U);
  EXPECT_EQ(config.executors[0].name, "control");
  EXPECT_EQ(config.executors[0].period, seconds(0.002));
  EXPECT_EQ(config.executors[0].priority, 20);
  EXPECT_EQ(config.executors[0].cpu, 0);
  EXPECT_TRUE(config.executors[0].lock_memory);
  EXPECT_EQ(config.executors[1].name, "main");
  EXPECT_FALSE(config.executors[1].lock_memory);
  EXPECT_FALSE(config.executors[1].cpu);
}

}  // namespace
}  // namespace armature
