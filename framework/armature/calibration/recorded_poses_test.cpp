// SPDX-License-Identifier: Apache-2.0
// Files of recorded poses: JSON lines and YAML, and what is wrong in them.
#include "armature/calibration/recorded_poses.hpp"

#include <gmock/gmock.h>

#include <fstream>
#include <functional>
#include <string>

#include "armature/config/problems.hpp"
#include "armature/robot/kinematics/kinematics.hpp"
#include "armature/values/temporary_folder.hpp"

namespace armature {
namespace {

using ::testing::ElementsAre;
using ::testing::StartsWith;

class RecordedPoses : public ::testing::Test {
 protected:
  const std::filesystem::path& file(const std::string& text) const {
    std::ofstream{file_} << text;
    return file_;
  }
  /// Without the file's name.
  std::vector<std::string> problems(const std::function<void()>& read) const {
    std::vector<std::string> texts;
    try {
      read();
    } catch (const config::ConfigError& error) {
      for (const auto& problem : error.problems()) {
        EXPECT_EQ(problem.origin.file, file_.string());
        texts.push_back(problem.text().substr(file_.string().size() + 1));
      }
    }
    return texts;
  }
  std::vector<std::string> problems_of_hand_eye(const std::string& text,
                                                const RobotModel* robot = nullptr) const {
    return problems([&] { read_hand_eye_poses(file(text), robot); });
  }

  const TemporaryFolder folder_;
  const std::filesystem::path file_ = folder_ / "recorded_poses";
  const RobotModel med7_ = load_robot_model(ARMATURE_SOURCE_DIR "/configs/robots/med7.yaml");
};

const std::string kFlange =
    R"("base_T_flange":{"position_m":[1,2,3],"quaternion_xyzw":[0,0,0.6,0.8]})";
const std::string kBody =
    R"("tracker_T_body":{"position_mm":[10,20,30],"quaternion_xyzw":[1,0,0,0]})";

TEST_F(RecordedPoses, AreTheSameAsJsonLinesAndAsYaml) {
  const auto lines = read_hand_eye_poses(
      file("{" + kFlange + "," + kBody + "}\n\n{" + kBody + ", " + kFlange + "}"), nullptr);
  const auto yaml = read_hand_eye_poses(
      file("armature_poses: 1\n"
           "poses:\n"
           "  - base_T_flange: {position_m: [1, 2, 3], quaternion_xyzw: [0, 0, 0.6, 0.8]}\n"
           "    tracker_T_body: {position_m: [0.01, 0.02, 0.03], quaternion_xyzw: [1, 0, 0, 0]}\n"
           "  - {" +
           kFlange + "," + kBody + "}\n"),
      nullptr);
  ASSERT_EQ(lines.size(), 2u);
  ASSERT_EQ(yaml.size(), 2u);
  for (const auto& poses : {lines, yaml}) {
    for (const HandEyePose& pose : poses) {
      EXPECT_TRUE(pose.base_T_flange.translation().isApprox(Eigen::Vector3d{1, 2, 3}));
      EXPECT_TRUE(
          pose.base_T_flange.linear().isApprox(Eigen::Quaterniond(0.8, 0, 0, 0.6).matrix()));
      EXPECT_TRUE(pose.tracker_T_body.translation().isApprox(Eigen::Vector3d{0.01, 0.02, 0.03}));
    }
  }
}

TEST_F(RecordedPoses, OfJointsAreThoseOfTheRobotsTool) {
  const auto poses =
      read_hand_eye_poses(file("{\"joints\":[0.1,0.2,0.3,0.4,0.5,0.6,0.7]," + kBody + "}"), &med7_);
  JointVector q(7);
  q << 0.1, 0.2, 0.3, 0.4, 0.5, 0.6, 0.7;
  ASSERT_EQ(poses.size(), 1u);
  EXPECT_TRUE(poses[0].base_T_flange.isApprox(forward_kinematics(med7_, q)));
}

TEST_F(RecordedPoses, OfAToolAreOfTheFlangeOrOfTheBody) {
  const ToolPoses body = read_tool_poses(file("{" + kBody + "}"), nullptr);
  EXPECT_TRUE(body.is_tracked);
  EXPECT_TRUE(body.fixed_T_body.at(0).translation().isApprox(Eigen::Vector3d{0.01, 0.02, 0.03}));
  const ToolPoses flange = read_tool_poses(file("{" + kFlange + "}"), nullptr);
  EXPECT_FALSE(flange.is_tracked);
  EXPECT_TRUE(flange.fixed_T_body.at(0).translation().isApprox(Eigen::Vector3d{1, 2, 3}));
  EXPECT_THAT(problems([&] {
                read_tool_poses(
                    file("{" + kBody + "}\n{" + kFlange + "}\n{" + kFlange + "," + kBody + "}\n{}"),
                    nullptr);
              }),
              ElementsAre("2:1: this pose is of the flange, the first one of the body",
                          "3:1: a pose of a tool is one of 'joints', 'base_T_flange' and "
                          "'tracker_T_body'",
                          "4:1: a pose of a tool is one of 'joints', 'base_T_flange' and "
                          "'tracker_T_body'"));
}

TEST_F(RecordedPoses, TellEverythingThatIsWrongInJsonLinesWithItsPlace) {
  EXPECT_THAT(
      problems_of_hand_eye(
          "{" + kFlange + "}\n" +                                                         //
              "{\"joints\":[0,0,0,0,0,0]," + kBody + "}\n" +                              //
              "{\"joints\":[0,0,0,0,0,0,0]," + kFlange + "," + kBody + "}\n" +            //
              "{\"base_T_flnge\":{}," + kBody + "}\n" +                                   //
              R"({"base_T_flange":{"position_m":[1,2],"quaternion_xyzw":[0,0,0,2]},)" +   //
              kBody + "}\n" +                                                             //
              R"({"base_T_flange":{"position_m":[1,2,NaN]},"tracker_T_body":[1,2,3]})" +  //
              "\n[1, 2]\n" +                                                              //
              "{\"joints\":[0,0,0\n",
          &med7_),
      ElementsAre(
          "1:1: a pose for hand-eye needs 'tracker_T_body'",
          "2:11: 'joints': 6 joint values; med7 has 7 joints",
          "3:43: 'joints' and 'base_T_flange' state the same; keep one",
          "4:1: a pose for hand-eye needs 'joints' or 'base_T_flange'",
          "4:2: unknown key 'base_T_flnge' in pose; did you mean 'base_T_flange'?",
          "5:32: 'position_m' must be a list of 3 numbers, not of 2",
          "5:56: 'quaternion_xyzw' has length 2, must be 1",
          "6:18: missing key 'quaternion_xyzw' in base_T_flange",
          "6:37: 'position_m' must be a list of 3 numbers; item 3 must be a number, not 'NaN'; it "
          "must be finite",
          "6:60: tracker_T_body must be a map, not a list", "7:1: a pose must be a map, not a list",
          "8:11: cannot be read as YAML: end of sequence flow not found; what opens here is not "
          "closed"));
}

TEST_F(RecordedPoses, MayHaveCommentsAndAByteOrderMarkThatShiftNoPlace) {
  const std::string pose = "{" + kFlange + "," + kBody + "}";
  EXPECT_EQ(read_hand_eye_poses(file("# two\n" + pose + "\n  # and\n" + pose), nullptr).size(), 2u);
  EXPECT_EQ(read_hand_eye_poses(file("\xEF\xBB\xBF" + pose + "\n" + pose), nullptr).size(), 2u);
  EXPECT_THAT(problems_of_hand_eye("\xEF\xBB\xBF# one\n{" + kFlange + "}"),
              ElementsAre("2:1: a pose for hand-eye needs 'tracker_T_body'"));
  EXPECT_THAT(problems_of_hand_eye("\xEF\xBB\xBF{\"poze\":1," + kFlange + "," + kBody + "}"),
              ElementsAre(StartsWith("1:2: unknown key 'poze' in pose")));
}

TEST_F(RecordedPoses, OfAnEmptyFileAreNoneAndItSaysWhatToWrite) {
  for (const char* text : {"", " \n\n", "# nothing yet\n", "\xEF\xBB\xBF"}) {
    EXPECT_THAT(problems_of_hand_eye(text),
                ElementsAre(StartsWith("1:1: no poses; write a JSON object with 'joints'")));
  }
}

TEST_F(RecordedPoses, OfJointsNeedTheirRobot) {
  EXPECT_THAT(problems_of_hand_eye("{\"joints\":[0,0,0,0,0,0,0]," + kBody + "}"),
              ElementsAre("1:11: 'joints' are those of a robot; name its file with --robot"));
}

TEST_F(RecordedPoses, TellWhatIsWrongInYaml) {
  EXPECT_THAT(
      problems_of_hand_eye("armature_poses: 2\npose: []\n"),
      ElementsAre("1:1: missing key 'poses' in file of poses",
                  "1:17: 'armature_poses' is 2, must be 1: the format that this version reads",
                  "2:1: unknown key 'pose' in file of poses; did you mean 'poses'?"));
  EXPECT_THAT(problems_of_hand_eye("armature_poses: 1\nposes: {}\n"),
              ElementsAre("2:8: 'poses' must be a list, not a map"));
  EXPECT_THAT(problems_of_hand_eye("armature_poses: 1\nposes: [7, {}]\n"),
              ElementsAre("2:9: a pose must be a map, not '7'",
                          "2:12: a pose for hand-eye needs 'joints' or 'base_T_flange'",
                          "2:12: a pose for hand-eye needs 'tracker_T_body'"));
  EXPECT_THAT(problems_of_hand_eye("[]\n"),
              ElementsAre("1:1: file of poses must be a map, not a list"));
}

}  // namespace
}  // namespace armature
