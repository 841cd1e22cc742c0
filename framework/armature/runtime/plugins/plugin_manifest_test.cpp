// SPDX-License-Identifier: Apache-2.0
#include "armature/runtime/plugins/plugin_manifest.hpp"

#include <gtest/gtest.h>

#include "tests/refusal.hpp"

namespace armature {
namespace {

constexpr const char* kHead = "armature_plugin: 1\nid: path/mine\nkind: path\n";

PluginManifest parse(const std::string& rest) {
  config::Problems problems;
  auto manifest = parse_manifest(kHead + rest, "plugin.yaml", problems);
  problems.throw_if_any();
  return manifest;
}

/// What is wrong with a plugin.yaml that goes on like this; "": nothing.
std::string problem(const std::string& rest) {
  return test::refusal_of([&] { parse(rest); });
}

TEST(PluginManifest, ReadsWhatAPluginNeedsOffersAndMeasures) {
  const PluginManifest manifest = parse(
      "params:\n"
      "  segment_s: {type: number, default: 1}\n"
      "  exact: {type: flag, default: true}\n"
      "requires: {time_law: {when: segment_s, doc: Its moves last segment_s}}\n"
      "provides:\n"
      "  stops: {}\n"
      "  straight: {when: exact}\n"
      "measures: {length_m: Of the path}\n");
  ASSERT_EQ(manifest.required.size(), 1U);
  EXPECT_EQ(manifest.required[0].word, "time_law");
  EXPECT_EQ(manifest.required[0].doc, "Its moves last segment_s");
  EXPECT_EQ(unless_text(manifest.required[0], manifest.params), "unless 'segment_s' is 0");
  ASSERT_EQ(manifest.provided.size(), 2U);
  EXPECT_EQ(unless_text(manifest.provided[0], manifest.params), "");
  EXPECT_EQ(unless_text(manifest.provided[1], manifest.params), "unless 'exact' is false");
  ASSERT_EQ(manifest.measures.size(), 1U);
  EXPECT_EQ(manifest.measures[0].name, "length_m");
  EXPECT_EQ(manifest.measures[0].doc, "Of the path");
}

TEST(PluginManifest, IsRefusedInAnotherFormatAndWithoutOne) {
  const auto said = [](const std::string& head) -> std::string {
    config::Problems problems;
    parse_manifest(head + "id: path/mine\nkind: path\n", "plugin.yaml", problems);
    return test::refusal_of([&] { problems.throw_if_any(); });
  };
  EXPECT_EQ(said("armature_plugin: 1\n"), "");
  for (const std::string format : {"2", "-7"}) {
    EXPECT_EQ(said("armature_plugin: " + format + "\n"),
              "plugin.yaml:1:18: 'armature_plugin' is " + format +
                  ", must be 1: the format that this version reads");
  }
  EXPECT_EQ(said(""), "plugin.yaml:1:1: missing key 'armature_plugin' in plugin.yaml");
}

TEST(PluginManifest, AMetricThatMayBeBelowZeroSaysSo) {
  const auto measures = parse("measures: {tremor_db: {signed: true, doc: Of the tip}}\n").measures;
  ASSERT_EQ(measures.size(), 1U);
  EXPECT_EQ(measures[0].doc, "Of the tip");
  EXPECT_TRUE(measures[0].may_be_negative);
  EXPECT_FALSE(parse("measures: {length_m: Of the path}\n").measures[0].may_be_negative);
  EXPECT_EQ(problem("measures: {tremor_db: {sign: true, doc: Of the tip}}\n"),
            "plugin.yaml:4:24: unknown key 'sign' in metric 'tremor_db'; did you mean 'signed'?");
}

TEST(PluginManifest, ATimeThatIsNoNumberIsOneProblem) {
  EXPECT_EQ(problem("max_step_s: abc\n"),
            "plugin.yaml:4:13: 'max_step_s' must be a number, not 'abc'");
  EXPECT_EQ(problem("in: {a: {type: std_msgs/Bool, max_age_s: abc}}\n"),
            "plugin.yaml:4:42: 'max_age_s' must be a number, not 'abc'");
}

TEST(PluginManifest, ADriverSaysWhatItMoves) {
  EXPECT_FALSE(parse("").driver);
  const auto simulated = parse("driver: {simulated: true}\n").driver;
  ASSERT_TRUE(simulated);
  EXPECT_TRUE(simulated->simulated);
  const auto real = parse("params: {port: {type: text}}\ndriver: {device: port}\n").driver;
  ASSERT_TRUE(real);
  EXPECT_FALSE(real->simulated);
  EXPECT_EQ(real->device, "port");
  EXPECT_EQ(problem("params: {port: {type: text}}\ndriver: {device: prot}\n"),
            "plugin.yaml:5:18: 'device' names 'prot', which is no parameter of the plugin; did you "
            "mean 'port'?");
}

TEST(PluginManifest, AConditionMustBeAParameterThatCanBeOff) {
  const std::string params =
      "params: {segment_s: {type: number, default: 1}, how: {type: text, default: x}}\n";
  EXPECT_EQ(problem(params + "requires: {time_law: {when: segment}}\n"),
            "plugin.yaml:5:29: 'when' names 'segment', which is no number, integer or flag among "
            "the plugin's parameters; did you mean 'segment_s'?");
  EXPECT_EQ(problem(params + "requires: {time_law: {when: how}}\n"),
            "plugin.yaml:5:29: 'when' names 'how', which is no number, integer or flag among the "
            "plugin's parameters; known: segment_s");
}

TEST(PluginManifest, AListWhereAMapBelongsIsAProblem) {
  EXPECT_EQ(problem("requires: [time_law]\n"),
            "plugin.yaml:4:11: 'requires' must be a map, not a list");
  EXPECT_EQ(problem("measures: length_m\n"),
            "plugin.yaml:4:11: 'measures' must be a map, not 'length_m'");
  EXPECT_EQ(problem("provides: {time_law: yes}\n"),
            "plugin.yaml:4:22: 'time_law' must be a map, not 'yes'");
  EXPECT_EQ(problem("requires:\n"), "");
}

TEST(PluginManifest, APortIsOfADocumentThatThePluginUses) {
  const std::string port = "in: {js: {type: sensor_msgs/JointState, of: robot}}\n";
  EXPECT_EQ(problem(port),
            "plugin.yaml:4:6: port 'js' is of a robot, and 'uses' and 'may_use' name none");
  EXPECT_EQ(problem("uses: [robot]\n" + port), "");
  EXPECT_EQ(problem("may_use: [robot]\n" + port), "");
}

TEST(PluginManifest, AStepMayTakeATimeThatIsPositive) {
  EXPECT_EQ(problem("max_step_s: 0\n"), "plugin.yaml:4:13: 'max_step_s' must be positive");
  EXPECT_EQ(parse("max_step_s: 0.25\n").max_step, seconds(0.25));
  EXPECT_FALSE(parse("").max_step);
}

TEST(PluginManifest, AnAgeThatIsNoneIsAProblem) {
  EXPECT_EQ(problem("in: {face: {type: armature_msgs/Target, max_age_s: 0}}\n"),
            "plugin.yaml:4:52: 'max_age_s' must be positive");
  const auto manifest = parse("in: {face: {type: armature_msgs/Target, max_age_s: 0.25}}\n");
  EXPECT_EQ(manifest.inputs[0].max_age, seconds(0.25));
  EXPECT_EQ(manifest.inputs[0].max_ahead, seconds(0.1));
  EXPECT_EQ(parse("in: {way: {type: armature_msgs/Target, max_ahead_s: 5}}\n").inputs[0].max_ahead,
            seconds(5));
  EXPECT_GT(parse("in: {way: {type: armature_msgs/Target, qos: latched}}\n").inputs[0].max_ahead,
            seconds(3600));
  EXPECT_EQ(problem("in: {face: {type: armature_msgs/Target, max_ahead_s: -1}}\n"),
            "plugin.yaml:4:54: 'max_ahead_s' must not be negative");
}

/// A plugin.yaml with an input that says this besides, and three parameters, one of them a time.
std::string with_input(const std::string& says) {
  return "params: {silence_s: {type: number, default: 1}, speed_m_s: {type: number, default: 1}, "
         "scale: {type: number, default: 1}}\n"
         "in: {face: {type: armature_msgs/Target, " +
         says + "}}\n";
}

TEST(PluginManifest, AnInputSaysHowLongItMayBeSilentAndWhatHappensThen) {
  const auto lease_of = [](const std::string& says) {
    return parse(with_input(says)).inputs[0].lease;
  };
  const auto named = lease_of("lease: {after: silence_s, then: it looks away}");
  ASSERT_TRUE(named);
  EXPECT_EQ(named->param, "silence_s");
  EXPECT_EQ(named->then, "it looks away");
  const auto fixed = lease_of("lease: {after: 0.25, then: it looks away}");
  ASSERT_TRUE(fixed);
  EXPECT_EQ(fixed->param, "");
  EXPECT_EQ(fixed->after, seconds(0.25));
  EXPECT_FALSE(lease_of("doc: The face"));
}

TEST(PluginManifest, AnInputThatMayGrowTooOldHasALeaseOfThatTime) {
  const auto lease_of = [](const std::string& says) {
    return parse(with_input(says)).inputs[0].lease.value();
  };
  EXPECT_EQ(lease_of("max_age_s: 0.1").after, seconds(0.1));
  EXPECT_EQ(lease_of("max_age_s: 0.1").then, "not shown to the component any more");
  EXPECT_EQ(lease_of("max_age_s: 0.1, lease: {then: it looks away}").after, seconds(0.1));
  EXPECT_EQ(lease_of("max_age_s: 0.1, lease: {then: it looks away}").then, "it looks away");
  EXPECT_EQ(problem(with_input("max_age_s: 0.1, lease: {after: 0.1, then: it looks away}")),
            "plugin.yaml:5:72: 'after' beside 'max_age_s', which is the lease's time already");
}

TEST(PluginManifest, ALeaseNamesATimeThatIsThere) {
  const auto problem_of = [](const std::string& lease) {
    return problem(with_input("lease: " + lease));
  };
  EXPECT_EQ(
      problem_of("{after: silence, then: it looks away}"),
      "plugin.yaml:5:56: 'after' names 'silence', which is no number in seconds (..._s) among "
      "the plugin's parameters; did you mean 'silence_s'?");
  EXPECT_EQ(problem_of("{after: speed_m_s, then: it looks away}"),
            "plugin.yaml:5:56: 'after' names 'speed_m_s', which is no number in seconds (..._s) "
            "among the plugin's parameters; known: silence_s");
  EXPECT_EQ(problem_of("{after: scale, then: it looks away}"),
            "plugin.yaml:5:56: 'after' names 'scale', which is no number in seconds (..._s) "
            "among the plugin's parameters; known: silence_s");
  EXPECT_EQ(problem_of("{after: 0, then: it looks away}"),
            "plugin.yaml:5:56: 'after' must be positive");
  EXPECT_EQ(problem_of("{after: -1, then: it looks away}"),
            "plugin.yaml:5:56: 'after' must be positive");
  EXPECT_EQ(problem_of("{after: '', then: it looks away}"),
            "plugin.yaml:5:56: 'after' must be a number, not ''");
  EXPECT_EQ(problem_of("{then: it looks away}"),
            "plugin.yaml:5:48: missing key 'after' in 'lease'");
  EXPECT_EQ(problem_of("{after: 1}"), "plugin.yaml:5:48: missing key 'then' in 'lease'");
  EXPECT_EQ(problem_of("{after: 1, then: \"it\\nlooks\"}"),
            "plugin.yaml:5:65: 'then' must be one line");
  EXPECT_EQ(problem_of("silence_s"), "plugin.yaml:5:48: 'lease' must be a map, not 'silence_s'");
}

}  // namespace
}  // namespace armature
