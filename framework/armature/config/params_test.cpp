// SPDX-License-Identifier: Apache-2.0
#include "armature/config/params.hpp"

#include <gtest/gtest.h>

#include <numbers>

#include "armature/config/document.hpp"
#include "tests/refusal.hpp"

namespace armature {
namespace {

using config::Node;
using config::parse_text;
using config::Problems;

std::string text_of(const Problems& problems) {
  std::string text;
  for (const config::Problem& problem : problems.sorted()) text += problem.text() + "\n";
  return text;
}

constexpr const char* kTable = R"(
rate_hz: {type: number, default: 10, min: 1, max: 120, doc: "Frames per second."}
tilt_deg: {type: number, default: 0}
tries: {type: integer, default: 3, min: 1}
blur: {type: flag, default: false}
label: {type: text, default: lamp}
photo: {type: choice, choices: [generated, astronaut], default: generated}
mouth_mm: {type: numbers, count: 3, max: 2000, default: [1550, 0, 450]}
model: {type: file, default: data/model.dat}
seed: {type: integer}
command: {type: texts, default: [solver, --fast]}
)";

std::vector<ParamSpec> specs_of(const std::string& table) {
  Problems problems;
  auto specs = read_param_specs(parse_text(table, "plugin.yaml"), problems);
  EXPECT_EQ(text_of(problems), "");
  return specs;
}

Params read(const std::string& given, Problems& problems) {
  const Node node = parse_text(given, "deployments/lamp.yaml");
  return Params::read(specs_of(kTable), &node, "sim/scene", problems);
}

TEST(ParamSpecs, KeepTheOrderAndContentOfTheTable) {
  const auto specs = specs_of(kTable);
  ASSERT_EQ(specs.size(), 10U);
  EXPECT_EQ(specs[0].name, "rate_hz");
  EXPECT_EQ(specs[0].type, ParamSpec::Type::number);
  EXPECT_EQ(specs[0].doc, "Frames per second.");
  EXPECT_EQ(specs[0].fallback->text(), "10");
  EXPECT_EQ(specs[0].min, 1.0);
  EXPECT_EQ(specs[0].max, 120.0);
  EXPECT_EQ(specs[5].choices, (std::vector<std::string>{"generated", "astronaut"}));
  EXPECT_EQ(specs[6].count, 3U);
  EXPECT_FALSE(specs[8].fallback);
  EXPECT_EQ(to_string(specs[7].type), "file");
  EXPECT_EQ(to_string(specs[9].type), "texts");
}

TEST(ParamSpecs, RefuseWhatIsNoTable) {
  Problems problems;
  read_param_specs(parse_text(R"(
a: {type: numbr, default: 5}
b: {default: 5}
c: {type: number, default: fast, minimum: 1}
d: {type: number, default: 5, max: 3}
e: {type: number, min: 3, max: 2}
f: {type: choice}
g: {type: choice, choices: [x, y], default: z}
h: {type: text, max: 3, count: 2}
Bad-Name: {type: flag}
i: {type: numbers, count: 2, default: [1]}
j: 5
k: {type: texts, default: [x, [y]]}
l: {type: number, same_as: task/mine}
m: {type: text, at_most: out.limit}
)",
                              "p"),
                   problems);
  EXPECT_EQ(text_of(problems),
            "p:2:11: 'type' cannot be 'numbr'; did you mean 'number'?\n"
            "p:3:4: missing key 'type' in parameter 'b'\n"
            "p:4:28: 'c' must be a number, not 'fast'\n"
            "p:4:34: unknown key 'minimum' in parameter 'c'; known: at_most, below, choices, "
            "count, default, doc, else, max, ...\n"
            "p:5:28: 'd' is 5, must be at most 3\n"
            "p:6:32: 'max' is 2, below 'min', which is 3\n"
            "p:7:4: a choice needs 'choices: [...]'\n"
            "p:8:45: 'g' cannot be 'z'; known: x, y\n"
            "p:9:22: 'max' belongs to a number\n"
            "p:9:32: 'count' belongs to numbers\n"
            "p:10:1: parameter 'Bad-Name' must be named in snake_case\n"
            "p:11:39: 'i' must be a list of 2 numbers, not of 1\n"
            "p:12:4: parameter 'j' must be a map, not '5'\n"
            "p:13:31: 'k' must be a list of texts; item 2 must be a text, not a list\n"
            "p:14:28: 'same_as' needs a default, for deployments without 'task/mine'\n"
            "p:15:26: 'at_most' belongs to a number\n");
}

TEST(ParamSpecs, OfAnEmptyTableAreNone) { EXPECT_TRUE(specs_of("").empty()); }

TEST(Parameters, FallBackToTheTable) {
  Problems problems;
  const Params params = read("seed: 7\n", problems);
  EXPECT_EQ(text_of(problems), "");
  EXPECT_EQ(params.number("rate_hz"), 10);
  EXPECT_EQ(params.integer("tries"), 3);
  EXPECT_EQ(params.flag("blur"), false);
  EXPECT_EQ(params.text("label"), "lamp");
  EXPECT_EQ(params.text("photo"), "generated");
  EXPECT_EQ(params.texts("command"), (std::vector<std::string>{"solver", "--fast"}));
  EXPECT_EQ(params.origin("rate_hz").text(), "plugin.yaml:2:34");
  EXPECT_EQ(params.origin("seed").text(), "deployments/lamp.yaml:1:7");
}

TEST(Parameters, ThatContradictEachOtherAreRefusedWhereTheFirstOfThemIsWritten) {
  Problems problems;
  const auto refusal = [](const Params& params) -> std::string {
    return test::refusal_of([&] {
      params.refuse({"rate_hz", "tries"}, "'rate_hz' is below 'tries'");
    });
  };
  EXPECT_EQ(refusal(read("{seed: 7, tries: 20}", problems)),
            "deployments/lamp.yaml:1:18: 'rate_hz' is below 'tries'");
  EXPECT_EQ(refusal(read("{tries: 20, seed: 7, rate_hz: 5}", problems)),
            "deployments/lamp.yaml:1:31: 'rate_hz' is below 'tries'");
  EXPECT_EQ(refusal(read("{seed: 7}", problems)),
            "deployments/lamp.yaml:1:1: 'rate_hz' is below 'tries'")
      << "at the parameters, of which none was written";
}

TEST(Parameters, ArriveInSiUnits) {
  Problems problems;
  const Params params = read("{seed: 7, tilt_deg: 180, mouth_mm: [1000, -500, 0]}", problems);
  EXPECT_DOUBLE_EQ(params.number("tilt_deg"), std::numbers::pi);
  EXPECT_EQ(params.numbers("mouth_mm"), (std::vector<double>{1, -0.5, 0}));
}

TEST(Parameters, OfTypeFileStartAtTheFolderOfTheFileThatSaysThem) {
  Problems problems;
  EXPECT_EQ(read("seed: 7", problems).file("model"), "data/model.dat");
  EXPECT_EQ(read("{seed: 7, model: ../m.dat}", problems).file("model"), "m.dat");
  EXPECT_EQ(read("{seed: 7, model: /m.dat}", problems).file("model"), "/m.dat");
  EXPECT_EQ(read("{seed: 7, model: \"\"}", problems).file("model"), "");
  const Node option = config::load_with_overlays({}, {"model=m.dat", "seed=7"});
  EXPECT_EQ(Params::read(specs_of(kTable), &option, "x", problems).file("model"), "m.dat");
}

TEST(Parameters, WithoutADefaultThatAreTextsOrFilesAreNotEmpty) {
  const auto specs =
      specs_of("device: {type: text}\nvolume: {type: file}\nlabel: {type: text, default: \"\"}\n");
  const Node given = parse_text("device: \"\"\nvolume: \"\"\nlabel: \"\"\n", "lamp.yaml");
  Problems problems;
  Params::read(specs, &given, "camera/mine", problems);
  EXPECT_EQ(text_of(problems),
            "lamp.yaml:1:9: 'device' is empty, and has no default\n"
            "lamp.yaml:2:9: 'volume' is empty, and has no default\n");
}

TEST(Parameters, OfTypeFileNameNoDevice) {
  Problems problems;
  read("{seed: 7, model: /dev/zero}", problems);
  ASSERT_EQ(problems.sorted().size(), 1U);
  EXPECT_EQ(problems.sorted().front().message,
            "'model' names '/dev/zero', which is a device or a pipe; name a file or a folder");
}

TEST(Parameters, ThatAreWrongAreAllTold) {
  Problems problems;
  const Params params = read(
      "rate_hz: 500\ntries: 0\nblur: yes\nlabel: [a]\nphoto: generatd\nmouth_mm: [1, 2, 3000]\n"
      "tilt_rad: 1\ncommand: solver\n",
      problems);
  EXPECT_EQ(text_of(problems),
            "deployments/lamp.yaml:1:1: missing key 'seed' in params of 'sim/scene'\n"
            "deployments/lamp.yaml:1:10: 'rate_hz' is 500, must be from 1 to 120\n"
            "deployments/lamp.yaml:2:8: 'tries' is 0, must be at least 1\n"
            "deployments/lamp.yaml:3:7: 'blur' must be true or false, not 'yes'\n"
            "deployments/lamp.yaml:4:8: 'label' must be a text, not a list\n"
            "deployments/lamp.yaml:5:8: 'photo' cannot be 'generatd'; did you mean 'generated'?\n"
            "deployments/lamp.yaml:6:18: 'mouth_mm' item 3 is 3000, must be at most 2000\n"
            "deployments/lamp.yaml:7:1: unknown key 'tilt_rad' in params of 'sim/scene'; did you "
            "mean 'tilt_deg'?\n"
            "deployments/lamp.yaml:8:10: 'command' must be a list of texts, not 'solver'\n");
  EXPECT_EQ(params.number("rate_hz"), 0) << "a wrong value still has an answer";
}

TEST(Parameters, ThatAreNotGivenAreMissedAtTheirPlace) {
  Problems problems;
  Params::read(specs_of(kTable), nullptr, "sim/scene", problems, {"lamp.yaml", 4, 2});
  const Node empty = parse_text("params:\n", "lamp.yaml");
  Params::read(specs_of(kTable), empty.find("params"), "sim/scene", problems);
  EXPECT_EQ(text_of(problems),
            "lamp.yaml:1:1: missing key 'seed' in params of 'sim/scene'\n"
            "lamp.yaml:4:2: missing key 'seed' in params of 'sim/scene'\n");
}

TEST(Parameters, ThatThePluginDoesNotDeclareAreItsDefect) {
  Problems problems;
  const Params params = read("seed: 7", problems);
  const auto defect = [](auto ask) -> std::string { return test::refusal_of([&] { ask(); }); };
  EXPECT_EQ(
      defect([&] { params.number("rate"); }),
      "'sim/scene' asks for the parameter 'rate', which its plugin.yaml does not declare; did "
      "you mean 'rate_hz'?");
  EXPECT_EQ(defect([&] { params.integer("rate_hz"); }),
            "'sim/scene' asks for the parameter 'rate_hz' as integer, but its plugin.yaml declares "
            "type number");
}

/// The message for two parameters that are not in the order that the file states.
std::string order_problem(const std::string& order, const std::string& given) {
  const Node table = config::parse_text(
      "{least: {type: integer, default: 3, " + order + "}, poses: {type: integer, default: 20}}",
      "t");
  Problems problems;
  const auto specs = read_param_specs(table, problems);
  const Node params = config::parse_text(given, "f");
  Params::read(specs, &params, "task/x", problems);
  return test::refusal_of([&] { problems.throw_if_any(); });
}

TEST(Parameters, MayBeComparedWithOneAnother) {
  EXPECT_EQ(order_problem("at_most: poses", "least: 20"), "");
  EXPECT_EQ(order_problem("at_most: poses", "least: 21"),
            "f:1:8: 'least' is 21, above 'poses', which is 20");
  EXPECT_EQ(order_problem("below: poses", "least: 19"), "");
  EXPECT_EQ(order_problem("below: poses, else: none would be left", "poses: 3"),
            "f:1:8: 'least' is 3, not below 'poses', which is 3: none would be left");
}

TEST(Parameters, AreNotComparedWithOneThatIsMissing) {
  const Node table = config::parse_text(
      "{least: {type: integer, default: 3, at_most: poses}, poses: {type: integer}}", "t");
  Problems problems;
  const auto specs = read_param_specs(table, problems);
  const Node params = config::parse_text("least: 4", "f");
  Params::read(specs, &params, "task/x", problems);
  EXPECT_EQ(text_of(problems), "f:1:1: missing key 'poses' in params of 'task/x'\n");
}

TEST(ParamSpecs, AreComparedWithWhatCanBeCompared) {
  const std::string ending = "which must be another parameter of the same type and unit";
  for (const char* const other :
       {"{a: {type: number, below: b}}", "{a: {type: number, below: b}, b: {type: integer}}",
        "{a_mm: {type: number, below: b}, b: {type: number}}"}) {
    Problems problems;
    read_param_specs(config::parse_text(other, "t"), problems);
    ASSERT_EQ(problems.sorted().size(), 1u) << other;
    EXPECT_TRUE(problems.sorted()[0].message.ends_with(ending)) << problems.sorted()[0].message;
  }
}

TEST(ParamSpecs, WhoseDefaultsBreakTheirOrderAreRefused) {
  Problems problems;
  read_param_specs(
      config::parse_text("{a: {type: number, default: 2, below: b}, b: {type: number, default: 1}}",
                         "t"),
      problems);
  ASSERT_EQ(problems.sorted().size(), 1u);
  EXPECT_EQ(problems.sorted()[0].text(), "t:1:1: 'a' is 2, not below 'b', which is 1");
}

TEST(ParamSpecs, StateAUnitThatIsRead) {
  Problems problems;
  read_param_specs(
      config::parse_text("{rate_deg_min: {type: number}, width_cm: {type: number}}", "t"),
      problems);
  ASSERT_EQ(problems.sorted().size(), 2u);
  EXPECT_EQ(problems.sorted()[0].message.substr(0, 43),
            "parameter 'rate_deg_min': '_deg_min' is no ");
  EXPECT_EQ(problems.sorted()[1].message.substr(0, 37), "parameter 'width_cm': '_cm' is no uni");
}

TEST(Parameters, AgreeWithOthersByTakingWhatWasNotWritten) {
  Problems problems;
  Params unwritten = read("seed: 1", problems), same = read("{seed: 1, tilt_deg: 5}", problems),
         other = read("{seed: 1, tilt_deg: 6}", problems);
  const Params five = read("{seed: 1, tilt_deg: 5}", problems);
  EXPECT_TRUE(unwritten.agree("tilt_deg", five));
  EXPECT_EQ(unwritten.number("tilt_deg"), five.number("tilt_deg"));
  EXPECT_EQ(unwritten.origin("tilt_deg").column, five.origin("tilt_deg").column);
  EXPECT_TRUE(same.agree("tilt_deg", five));
  EXPECT_FALSE(other.agree("tilt_deg", five));
  EXPECT_FALSE(unwritten.agree("tilt_deg", other)) << "it has agreed with another";
}

}  // namespace
}  // namespace armature
