// SPDX-License-Identifier: Apache-2.0
// `armature calibrate hand-eye` and `armature calibrate tool`, from recorded poses to the frames of
// a robot file. tests/data/calibration was recorded from a simulated tracker, 0.12 mm rms a sphere;
// what it stands for is known.
#include <gtest/gtest.h>
#include <sys/stat.h>

#include <array>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "armature/values/file_content.hpp"
#include "armature/values/temporary_folder.hpp"
#include "command.hpp"

namespace armature::test {
namespace {

using nlohmann::json;
namespace fs = std::filesystem;
using Point = std::array<double, 3>;

const std::string kMed7 = source_file("configs/robots/med7.yaml");
const std::string kHandEye = source_file("tests/data/calibration/hand_eye.jsonl");
const std::string kTool = source_file("tests/data/calibration/tool.jsonl");

constexpr Point kTrackerInBase{1.5, -0.3, 0.9};  // [m], as in dental_implant_reference.yaml
constexpr Point kBodyOnFlange{0.06, -0.035, 0.08};
constexpr Point kTipInBody{0.012, -0.004, 0.152};

double distance(const Point& a, const Point& b) {
  return std::hypot(a[0] - b[0], a[1] - b[1], a[2] - b[2]);
}

class Calibrate : public testing::Test {
 protected:
  std::string in_folder(const std::string& name) const { return (folder_ / name).string(); }
  std::string write(const std::string& name, const std::string& text) const {
    std::ofstream{folder_ / name} << text;
    return in_folder(name);
  }
  static CommandResult calibrate(std::vector<std::string> arguments) {
    arguments.insert(arguments.begin(), {armature(), "calibrate"});
    return run_command(arguments);
  }
  static json calibrated(std::vector<std::string> arguments) {
    arguments.push_back("--json");
    const CommandResult result = calibrate(std::move(arguments));
    EXPECT_EQ(result.exit_code, 0) << result.err;
    return json::parse(result.out);
  }
  /// An error, without the folder.
  std::string refusal(const std::vector<std::string>& arguments, int exit_code) const {
    const CommandResult result = calibrate(arguments);
    EXPECT_EQ(result.exit_code, exit_code);
    EXPECT_EQ(result.out, "");
    std::string text = result.err;
    const std::string name = folder_.path().string() + "/";
    for (std::size_t at; (at = text.find(name)) != std::string::npos;) text.erase(at, name.size());
    return text;
  }
  std::vector<std::string> lines_of(const std::string& file) const {
    std::vector<std::string> lines;
    std::ifstream in{file};
    for (std::string line; std::getline(in, line);) lines.push_back(line + "\n");
    return lines;
  }
  static std::string joined(const std::vector<std::string>& lines) {
    std::string text;
    for (const std::string& line : lines) text += line;
    return text;
  }

  const TemporaryFolder folder_;
};

TEST_F(Calibrate, FindsTheTrackerAndTheBodyAsWellAsItSays) {
  const json found =
      calibrated({"hand-eye", kHandEye, "--robot", kMed7, "--at", "1.5", "-0.3", "0.9"});
  EXPECT_EQ(found["poses"], 20);
  EXPECT_EQ(found["kind"], "hand_eye");
  const double tracker_mm =
      1e3 * distance(found["base_T_tracker"]["translation_m"], kTrackerInBase);
  const double body_mm = 1e3 * distance(found["flange_T_body"]["translation_m"], kBodyOnFlange);
  EXPECT_LE(tracker_mm, found["expected_error"]["bound95_mm"].get<double>());
  EXPECT_LE(body_mm, found["expected_error_of_body"]["bound95_mm"].get<double>());
  EXPECT_LE(tracker_mm, 0.2);
  EXPECT_LE(body_mm, 0.05);
  // A half of a sphere's noise along each axis.
  EXPECT_NEAR(found["noise_per_axis"]["position_mm"].get<double>(), 0.035, 0.005);
}

TEST_F(Calibrate, FindsTheTipAsWellAsItSays) {
  const json found = calibrated({"tool", kTool});
  EXPECT_EQ(found["kind"], "tool");
  const double tip_mm = 1e3 * distance(found["body_T_tool"]["translation_m"], kTipInBody);
  EXPECT_LE(tip_mm, found["expected_error"]["bound95_mm"].get<double>());
  EXPECT_LE(found["expected_error"]["bound95_mm"].get<double>(), 0.3);
}

TEST_F(Calibrate, AStatedNoiseIsTakenAsItIs) {
  const json found = calibrated({"hand-eye", "--noise", "0.05", "0.1", kHandEye, "--robot", kMed7});
  EXPECT_EQ(found["noise_per_axis"],
            json::parse(R"({"from": "stated", "position_mm": 0.05, "rotation_deg": 0.1})"));
}

TEST_F(Calibrate, TellsWhenByWhatMethodAndInWhichUnits) {
  const CommandResult result = calibrate({"tool", kTool});
  EXPECT_EQ(result.err, "");
  for (const char* text :
       {"armature_calibration: 1\n", "kind: tool\n", "method: \"least squares of one fixed point",
        "date_utc: 20", "poses_file: ", "poses: 30\n", "body_T_tool:\n  translation_m: [",
        "tracker_T_point:\n", "residual:\n  rms_mm: 0.3697\n  worst_pose: 30\n  worst_mm: 0.6131\n",
        "orientation_spread_deg: 30.5\n", "expected_error:\n  rms_mm: 0.1058\n"}) {
    EXPECT_NE(result.out.find(text), std::string::npos) << text << "\n" << result.out;
  }
}

TEST_F(Calibrate, TheRobotFilesFramesStandWhereTheCalibrationsFoundThem) {
  const json hand_eye =
      calibrated({"hand-eye", kHandEye, "--robot", kMed7, "-o", in_folder("hand_eye.yaml")});
  const json tool = calibrated({"tool", kTool, "-o", in_folder("tool.yaml")});
  const std::string arm =
      write("arm.yaml", "include: " + kMed7 +
                            "\n"
                            "frames:\n"
                            "  body: {parent: flange, calibrated: hand_eye.yaml}\n"
                            "  tracker: {parent: base, calibrated: hand_eye.yaml}\n"
                            "  tool: {parent: body, calibrated: tool.yaml, translation_m: "
                            "null}\n");
  const auto position = [&](const std::string& tip) -> Point {
    const CommandResult result =
        run_command({armature(), "fk", "--robot", arm, "--tip", tip},
                    {.environment = {}, .input = "{\"joints\":[0,0,0,0,0,0,0]}\n"});
    EXPECT_EQ(result.exit_code, 0) << result.err;
    return json::parse(result.out)["position_m"];
  };
  const Point body = hand_eye["flange_T_body"]["translation_m"];
  const Point tracker = hand_eye["base_T_tracker"]["translation_m"];
  EXPECT_LE(distance(position("tracker"), tracker), 1e-12);
  // The arm is upright: its flange looks up at 1.266 m.
  EXPECT_LE(distance(position("body"), {body[0], body[1], body[2] + 1.266}), 1e-12);
  const Point tip = tool["body_T_tool"]["translation_m"];
  EXPECT_NEAR(distance(position("tool"), position("body")), distance(tip, {0, 0, 0}), 1e-12);
}

TEST_F(Calibrate, NamesItsFramesAsItIsTold) {
  const json found =
      calibrated({"tool", kTool, "--body", "marker", "--tool", "drill", "--tracker", "vega"});
  EXPECT_TRUE(found.contains("marker_T_drill"));
  EXPECT_TRUE(found.contains("vega_T_point"));
}

TEST_F(Calibrate, LeavesAnOlderResultAloneWhenItRefuses) {
  const std::string output = write("tool.yaml", "the older one\n");
  std::vector<std::string> lines = lines_of(kTool);
  lines.resize(2);
  EXPECT_EQ(refusal({"tool", write("two.jsonl", joined(lines)), "-o", output}, 1),
            "armature: two.jsonl: 2 poses, at least 3 are needed\n");
  EXPECT_EQ(content_of(output), "the older one\n");
  EXPECT_EQ(calibrate({"tool", kTool, "-o", output}).exit_code, 0);
  EXPECT_EQ(content_of(output).substr(0, 30), "# For a robot file: frames: {t");
  EXPECT_EQ(std::distance(fs::directory_iterator{folder_.path()}, {}), 2)
      << "something is left beside it";
}

TEST_F(Calibrate, NamesAPoseThatDoesNotFit) {
  std::vector<std::string> lines = lines_of(kHandEye);
  const std::string body = lines[4].substr(lines[4].find(",\"tracker_T_body\""));
  lines[11] = lines[11].substr(0, lines[11].find(",\"tracker_T_body\"")) + body;
  const std::string text =
      refusal({"hand-eye", write("mixed.jsonl", joined(lines)), "--robot", kMed7}, 1);
  EXPECT_TRUE(text.starts_with("armature: mixed.jsonl: pose 12 does not fit the others: it is "))
      << text;
}

struct BadPoses {
  const char* name;
  std::vector<std::string> arguments;  // after the file
  const char* text;
  int exit_code;
  const char* message;
};
void PrintTo(const BadPoses& bad, std::ostream* out) { *out << bad.name; }

class CalibrateRefuses : public Calibrate, public testing::WithParamInterface<BadPoses> {};

TEST_P(CalibrateRefuses, WithAReason) {
  std::vector<std::string> arguments{GetParam().arguments.front(),
                                     write("bad.jsonl", GetParam().text)};
  arguments.insert(arguments.end(), GetParam().arguments.begin() + 1, GetParam().arguments.end());
  EXPECT_EQ(refusal(arguments, GetParam().exit_code), GetParam().message);
}

const BadPoses kBadPoses[] = {
    {"BrokenJson",
     {"tool"},
     "{\"tracker_T_body\": {\n",
     3,
     "bad.jsonl:1:20: cannot be read as YAML: end of map flow not found; what opens here is not "
     "closed\n"},
    {"NoNumber",
     {"tool"},
     R"({"tracker_T_body":{"position_m":[0,0,NaN],"quaternion_xyzw":[0,0,0,1]}})",
     3,
     "bad.jsonl:1:38: 'position_m' must be a list of 3 numbers; item 3 must be a number, not "
     "'NaN'; it must be "
     "finite\n"},
    {"NoRotation",
     {"tool"},
     R"({"tracker_T_body":{"position_m":[0,0,1],"quaternion_xyzw":[0,0,0,0]}})",
     3,
     "bad.jsonl:1:59: 'quaternion_xyzw' has length 0, must be 1\n"},
    {"UnknownKey",
     {"tool"},
     R"({"tracker_T_bdy":{"position_m":[0,0,1],"quaternion_xyzw":[0,0,0,1]}})",
     3,
     "bad.jsonl:1:1: a pose of a tool is one of 'joints', 'base_T_flange' and "
     "'tracker_T_body'\nbad.jsonl:1:2: unknown key 'tracker_T_bdy' in pose; did you mean "
     "'tracker_T_body'?\n"},
    {"JointsWithoutARobot",
     {"tool"},
     R"({"joints":[0,0,0,0,0,0,0]})",
     3,
     "bad.jsonl:1:11: 'joints' are those of a robot; name its file with --robot\n"},
    {"JointsOfAnotherRobot",
     {"tool", "--robot", kMed7},
     R"({"joints":[0,0,0]})",
     3,
     "bad.jsonl:1:11: 'joints': 3 joint values; med7 has 7 joints\n"},
    {"AFlangeThatTheRobotDoesNotHave",
     {"tool", "--robot", kMed7, "--tip", "flnge"},
     "{}",
     3,
     "armature: robot 'med7' has no frame 'flnge'; did you mean 'flange'?\n"},
    {"HandEyeWithoutABody",
     {"hand-eye", "--robot", kMed7},
     R"({"joints":[0,0,0,0,0,0,0]})",
     3,
     "bad.jsonl:1:1: a pose for hand-eye needs 'tracker_T_body'\n"},
    {"APointThatIsNone",
     {"hand-eye", "--at", "nan", "0", "0"},
     "{}",
     3,
     "armature: --at is a point in metres, at most 1000 from the base; nan is none\n"},
    {"APointBeyondAllMeasure",
     {"hand-eye", "--at", "0", "0", "1e300"},
     "{}",
     3,
     "armature: --at is a point in metres, at most 1000 from the base; 1e+300 is none\n"},
    {"OneNameForTwoFrames",
     {"hand-eye", "--body", "vega", "--tracker", "vega"},
     "{}",
     3,
     "armature: --body and --tracker are both called 'vega'; a frame's name is its own\n"},
    {"TheNameOfTheBase",
     {"hand-eye", "--tracker", "base"},
     "{}",
     3,
     "armature: the robot's base and --tracker are both called 'base'; a frame's name is its "
     "own\n"},
    {"TheNameOfTheBaseForTheBodyOfATool",
     {"tool", "--body", "base"},
     R"({"tracker_T_body":{"position_m":[0,0,1],"quaternion_xyzw":[0,0,0,1]}})",
     3,
     "armature: the robot's base and --body are both called 'base'; a frame's name is its own\n"},
    {"TheNameOfTheFlangeForTheTool",
     {"tool", "--tool", "flange"},
     R"({"tracker_T_body":{"position_m":[0,0,1],"quaternion_xyzw":[0,0,0,1]}})",
     3,
     "armature: --tip and --tool are both called 'flange'; a frame's name is its own\n"},
    {"TheNameOfAJoint",
     {"hand-eye", "--robot", kMed7, "--tracker", "j3"},
     "{}",
     3,
     "armature: a joint of the robot and --tracker are both called 'j3'; a frame's name is its "
     "own\n"},
    {"ANameWithALineEnd",
     {"hand-eye", "--body", "a\nb"},
     "{}",
     3,
     "armature: --body is a frame's name of letters, digits, '_', '-', '.' and '/'; 'a\\nb' is "
     "none\n"},
    {"NoName",
     {"tool", "--tool", ""},
     R"({"tracker_T_body":{"position_m":[0,0,1],"quaternion_xyzw":[0,0,0,1]}})",
     3,
     "armature: --tool is a frame's name of letters, digits, '_', '-', '.' and '/'; '' is none\n"},
    {"TheNameOfTheBodyForTheTool",
     {"tool", "--tool", "body"},
     R"({"tracker_T_body":{"position_m":[0,0,1],"quaternion_xyzw":[0,0,0,1]}})",
     3,
     "armature: --body and --tool are both called 'body'; a frame's name is its own\n"},
    {"ANoiseThatIsNone",
     {"hand-eye", "--noise", "0.1", "nan"},
     "{}",
     3,
     "armature: --noise must be positive, at most 1000; nan is not\n"},
    {"NoPosesAtAll",
     {"tool"},
     "armature_poses: 1\nposes: []\n",
     1,
     "armature: bad.jsonl: 0 poses, at least 3 are needed\n"},
};
INSTANTIATE_TEST_SUITE_P(Poses, CalibrateRefuses, testing::ValuesIn(kBadPoses),
                         [](const auto& bad) { return std::string{bad.param.name}; });

TEST_F(Calibrate, SaysWhichFileCannotBeReadOrWritten) {
  EXPECT_EQ(refusal({"tool", in_folder("gone.jsonl")}, 3),
            "cannot read 'gone.jsonl': No such file or directory\n");
  EXPECT_EQ(refusal({"tool", kTool, "-o", in_folder("gone/tool.yaml")}, 1),
            "armature: cannot write 'gone/tool.yaml': No such file or directory\n");
  EXPECT_EQ(refusal({"tool", kTool, "-o", folder_.path().string()}, 1),
            "armature: cannot write '" + folder_.path().string() + "': it is no regular file\n");
  EXPECT_EQ(refusal({"tool", kTool, "-o", ""}, 1),
            "armature: cannot write '': No such file or directory\n");
}

TEST_F(Calibrate, NeverWritesOverTheRecording) {
  const std::string poses = write("mine.jsonl", content_of(kTool));
  EXPECT_EQ(refusal({"tool", poses, "-o", poses}, 3),
            "armature: -o mine.jsonl: that is the recording; give the result another name\n");
  EXPECT_EQ(content_of(poses), content_of(kTool));
}

TEST_F(Calibrate, NeverWritesOverTheRobotFile) {
  const std::string robot = write("arm.yaml", content_of(kMed7));
  EXPECT_EQ(refusal({"hand-eye", kHandEye, "--robot", robot, "-o", robot}, 3),
            "armature: -o arm.yaml: that is the robot file; give the result another name\n");
  EXPECT_EQ(content_of(robot), content_of(kMed7));
}

TEST_F(Calibrate, ADashIsStandardOutputAndNoFile) {
  const CommandResult dash = calibrate({"tool", kTool, "-o", "-"});
  EXPECT_EQ(dash.exit_code, 0) << dash.err;
  EXPECT_EQ(dash.out.substr(0, 66),
            "# For a robot file: frames: {tool: {parent: body, calibrated: THIS");
  EXPECT_FALSE(fs::exists("-"));
  EXPECT_EQ(refusal({"tool", kTool, "-o", "-", "--json"}, 3),
            "armature: --json and '-o -' both print on standard output; leave one out\n");
}

TEST_F(Calibrate, WhatCannotBePrintedWasNotDone) {
  const CommandResult result =
      run_command({"/bin/sh", "-c", armature() + " calibrate tool " + kTool + " > /dev/full"});
  EXPECT_EQ(result.exit_code, 1);
  EXPECT_EQ(result.err, "armature: standard output cannot be written: No space left on device\n");
}

TEST_F(Calibrate, WritesWhereALinkPointsAndNeverOverAPipe) {
  const std::string output = write("result.yaml", "the older one\n"), link = in_folder("link.yaml"),
                    pipe = in_folder("pipe");
  fs::create_symlink(output, link);
  EXPECT_EQ(calibrate({"tool", kTool, "-o", link}).exit_code, 0);
  EXPECT_TRUE(fs::is_symlink(link));
  EXPECT_EQ(content_of(output).substr(0, 30), "# For a robot file: frames: {t");
  ASSERT_EQ(mkfifo(pipe.c_str(), 0600), 0);
  EXPECT_EQ(refusal({"tool", kTool, "-o", pipe}, 1),
            "armature: cannot write 'pipe': it is no regular file\n");
  EXPECT_TRUE(fs::is_fifo(pipe));
}

TEST_F(Calibrate, ARecordSaidTwiceIsNoTwoMeasurements) {
  std::vector<std::string> lines = lines_of(kTool);
  lines.push_back(lines[4]);
  EXPECT_EQ(refusal({"tool", write("twice.jsonl", joined(lines))}, 1),
            "armature: twice.jsonl: poses 5 and " + std::to_string(lines.size()) +
                " are one record, said twice\n");
}

TEST_F(Calibrate, ARobotFileWithoutItsCalibrationIsRefused) {
  const std::string arm =
      write("arm.yaml", "include: " + kMed7 +
                            "\n"
                            "frames: {tool: {calibrated: tool.yaml, translation_m: null}}\n");
  const auto message = [&] {
    const CommandResult result = run_command({armature(), "fk", "--robot", arm});
    EXPECT_EQ(result.exit_code, 3);
    return result.err.substr(folder_.path().string().size() + 1);
  };
  EXPECT_EQ(message(), "arm.yaml:2:29: cannot read '" + in_folder("tool.yaml") +
                           "': No such file or directory\n");
  ASSERT_EQ(calibrate({"tool", kTool, "-o", in_folder("tool.yaml")}).exit_code, 0);
  EXPECT_EQ(message(),
            "arm.yaml:2:29: 'tool.yaml' holds body_T_tool, tracker_T_point, not flange_T_tool\n");
}

}  // namespace
}  // namespace armature::test
