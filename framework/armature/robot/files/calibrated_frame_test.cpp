// SPDX-License-Identifier: Apache-2.0
// A frame of a robot file that stands where a calibration found it: `calibrated: tool.yaml`.
#include <gmock/gmock.h>

#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

#include "armature/config/document.hpp"
#include "armature/robot/geometry/rotation.hpp"
#include "armature/robot/model/robot_model.hpp"
#include "armature/values/temporary_folder.hpp"
#include "tests/refusal.hpp"

namespace armature {
namespace {

using ::testing::ElementsAre;

class CalibratedFrameOfARobot : public ::testing::Test {
 protected:
  CalibratedFrameOfARobot() {
    std::filesystem::create_directories(folder_ / "found");
    write("found/tool.yaml",
          "armature_calibration: 1\n"
          "method: pivot\n"
          "flange_T_tool: {translation_mm: [1, -2, 150]}\n");
    write("found/hand_eye.yaml",
          "armature_calibration: 1\n"
          "flange_T_body:\n"
          "  translation_m: [0.06, -0.035, 0.08]\n"
          "  quaternion_xyzw: [0, 0, 0.6, 0.8]\n"
          "base_T_tracker: {translation_m: [1.5, 0, 1], quaternion_xyzw: [1, 0, 0, 0]}\n");
  }

  void write(const std::string& name, const std::string& text) const {
    std::ofstream{folder_ / name} << text;
  }
  RobotModel with(const std::string& frames) const {
    write("arm.yaml",
          "armature_robot: 1\n"
          "name: one\n"
          "joints: [{name: j, limits_deg: [-9, 9], velocity_rad_s: 1, acceleration_rad_s2: 2}]\n"
          "frames:\n"
          "  flange: {parent: j, translation_m: [0, 0, 1]}\n" +
              frames);
    return load_robot_model(folder_ / "arm.yaml");
  }
  /// Without the folder.
  std::vector<std::string> problems_with(const std::string& frames) const {
    std::vector<std::string> texts = test::problems_of([&] { with(frames); });
    const std::string folder = folder_.path().string() + "/";
    for (std::string& text : texts) {
      for (std::size_t at; (at = text.find(folder)) != std::string::npos;) {
        text.erase(at, folder.size());
      }
    }
    return texts;
  }
  static Eigen::Isometry3d frame(const RobotModel& robot, const char* name) {
    return robot.frame(*robot.find_frame(name)).parent_T_frame;
  }

  const TemporaryFolder folder_;
};

TEST_F(CalibratedFrameOfARobot, StandsWhereThePivotFoundItAndIsTurnedAsTheRobotFileSays) {
  const RobotModel robot =
      with("  tool: {parent: flange, calibrated: found/tool.yaml, rpy_deg: [0, 90, 0]}\n");
  const Eigen::Isometry3d tool = frame(robot, "tool");
  EXPECT_TRUE(tool.translation().isApprox(Eigen::Vector3d{0.001, -0.002, 1.15}));
  EXPECT_TRUE(tool.linear().isApprox(rotation_from_rpy({0, M_PI / 2, 0})));
}

TEST_F(CalibratedFrameOfARobot, IsTurnedAsHandEyeFoundIt) {
  const RobotModel robot = with(
      "  tool: {parent: flange}\n"
      "  body: {parent: flange, calibrated: found/hand_eye.yaml}\n"
      "  tracker: {parent: base, calibrated: found/hand_eye.yaml}\n");
  EXPECT_TRUE(frame(robot, "body").translation().isApprox(Eigen::Vector3d{0.06, -0.035, 1.08}));
  EXPECT_TRUE(frame(robot, "body").linear().isApprox(Eigen::Quaterniond(0.8, 0, 0, 0.6).matrix()));
  EXPECT_EQ(robot.frame(*robot.find_frame("tracker")).parent_joint, -1);
  EXPECT_TRUE(frame(robot, "tracker")
                  .linear()
                  .isApprox(Eigen::Vector3d{1, -1, -1}.asDiagonal().toDenseMatrix()));
}

TEST_F(CalibratedFrameOfARobot, IsNotStatedAgain) {
  EXPECT_THAT(
      problems_with("  tool: {parent: flange, calibrated: found/tool.yaml, translation_mm: [0, 0, "
                    "150]}\n"
                    "  body: {parent: flange, calibrated: found/hand_eye.yaml, rpy_deg: [0, 0, "
                    "0]}\n"),
      ElementsAre("arm.yaml:6:71: 'translation_mm' and 'calibrated' state the same; keep one",
                  "arm.yaml:7:68: 'rpy_deg' and 'calibrated' state the same; keep one"));
}

TEST_F(CalibratedFrameOfARobot, NamesTheFilesAndPlacesOfWhatIsWrong) {
  write("found/bad.yaml",
        "armature_calibration: 2\n"
        "flange_T_tool: {translation_m: [0, 0.1], quaternion_xyzw: [0, 0, 0, 2], colour: red}\n");
  write("found/list.yaml", "[1, 2]\n");
  write("found/broken.yaml", "armature_calibration: 1\nflange_T_broken: {translation_m: [0, 0\n");
  EXPECT_THAT(
      problems_with("  tool: {parent: flange, calibrated: found/bad.yaml}\n"
                    "  drill: {parent: flange, calibrated: found/hand_eye.yaml}\n"
                    "  list: {parent: flange, calibrated: found/list.yaml}\n"
                    "  broken: {parent: flange, calibrated: found/broken.yaml}\n"
                    "  gone: {parent: flange, calibrated: found/gone.yaml}\n"
                    "  number: {parent: flange, calibrated: [0, 1]}\n"),
      ElementsAre("found/bad.yaml:1:23: 'armature_calibration' is 2, must be 1: the format that "
                  "this version reads",
                  "found/bad.yaml:2:32: 'translation_m' must be a list of 3 numbers, not of 2",
                  "found/bad.yaml:2:59: 'quaternion_xyzw' has length 2, must be 1",
                  "found/bad.yaml:2:73: unknown key 'colour' in flange_T_tool; known: "
                  "quaternion_xyzw, translation_m, translation_mm",
                  "arm.yaml:7:39: 'found/hand_eye.yaml' holds flange_T_body, base_T_tracker, not "
                  "flange_T_drill",
                  "arm.yaml:10:38: cannot read 'found/gone.yaml': No such file or directory",
                  "arm.yaml:11:40: 'calibrated' must be the path of a file that `armature "
                  "calibrate` wrote, not a list",
                  "found/list.yaml:1:1: calibration must be a map, not a list",
                  "found/broken.yaml:2:34: cannot be read as YAML: end of sequence flow not found; "
                  "what opens here is not closed"));
}

}  // namespace
}  // namespace armature
