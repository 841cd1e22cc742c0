// SPDX-License-Identifier: Apache-2.0
// `armature calibrate stereo`: pictures of a board before two bent cameras that are known, as
// files, to a calibration and a rig that a deployment takes.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <opencv2/imgcodecs.hpp>
#include <random>

#include "armature/robot/geometry/rotation.hpp"
#include "armature/values/file_content.hpp"
#include "armature/values/temporary_folder.hpp"
#include "calibration_file.hpp"
#include "rectification.hpp"
#include "rendered_board_test.hpp"
#include "tests/command.hpp"

namespace armature::test {
namespace {

namespace fs = std::filesystem;
using Eigen::Vector3d, testing::ContainsRegex, testing::HasSubstr;

constexpr int kAcross = 640, kDown = 480;
constexpr double kSquare = 0.025;
const chessboard::BoardShape kShape{.columns = 9, .rows = 6};
const stereo::Lens kLeftLens{
    .fx = 520, .fy = 523, .cx = 316, .cy = 236, .distortion = {-0.22, 0.07, 0.0012, -0.0008}};
const stereo::Lens kRightLens{
    .fx = 528, .fy = 526, .cx = 325, .cy = 247, .distortion = {-0.2, 0.06, -0.001, 0.0011}};

Eigen::Isometry3d right_T_left() {
  Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
  pose.linear() = rotation_from_rpy({0.02, -0.03, 0.012});
  pose.translation() = Vector3d{-0.06, 0.001, -0.002};
  return pose;
}

/// Pictures of a board in two folders.
class DrawnBoards {
 public:
  explicit DrawnBoards(int pairs) {
    for (const char* side : {"left", "right"}) fs::create_directories(folder_ / side);
    std::mt19937_64 random{21};
    std::uniform_real_distribution<double> unit{-1, 1};
    const chessboard::BoardCamera left{kLeftLens, kAcross, kDown},
        right{kRightLens, kAcross, kDown};
    for (int i = 0; i < pairs; ++i) {
      Eigen::Isometry3d left_T_board = Eigen::Isometry3d::Identity();
      left_T_board.linear() =
          rotation_from_rpy({0.55 * unit(random), 0.55 * unit(random), 0.3 * unit(random)});
      const Vector3d middle{0.03 + 0.05 * unit(random), 0.04 * unit(random),
                            0.38 + 0.05 * unit(random)};
      left_T_board.translation() =
          middle - left_T_board.linear() * Vector3d{4 * kSquare, 2.5 * kSquare, 0};
      const std::string name = std::to_string(i) + ".png";
      write(left.picture(left_T_board, kShape, kSquare, 2, 2 * i), "left/" + name);
      write(right.picture(right_T_left() * left_T_board, kShape, kSquare, 2, 2 * i + 1),
            "right/" + name);
    }
  }
  fs::path path(const std::string& name) const { return folder_ / name; }

 private:
  void write(const std::vector<std::uint8_t>& pixels, const std::string& name) const {
    cv::imwrite(path(name),
                cv::Mat(kDown, kAcross, CV_8UC1, const_cast<std::uint8_t*>(pixels.data())));
  }
  const TemporaryFolder folder_;
};

CommandResult calibrate(const DrawnBoards& boards, const std::vector<std::string>& more) {
  std::vector<std::string> words{armature(), "calibrate", "stereo", "--square-mm", "25"};
  for (const auto& [option, name] :
       {std::pair{"--left", "left"}, {"--right", "right"}, {"-o", "head.yaml"}}) {
    words.insert(words.end(), {option, boards.path(name)});
  }
  words.insert(words.end(), more.begin(), more.end());
  return run_command(words);
}

TEST(CalibrateStereo, FindsTheCamerasWithinWhatItSaysOfItselfAndWritesWhatADeploymentTakes) {
  constexpr int kPairs = 12;
  const DrawnBoards boards{kPairs};
  const std::string rig = boards.path("rig.yaml"), cover = boards.path("cover.svg");
  const CommandResult result =
      calibrate(boards, {"--board", "9", "6", "--rig", rig, "--coverage", cover, "--json"});
  ASSERT_EQ(result.exit_code, 0) << result.err;
  const auto told = nlohmann::json::parse(result.out);
  EXPECT_EQ(told["pairs"], kPairs);
  EXPECT_GE(told["pairs_used"], kPairs - 3);
  EXPECT_LT(told["left_residual_rms_px"], 0.15);
  EXPECT_LT(told["right_residual_rms_px"], 0.15);
  EXPECT_LT(told["row_error_rms_px"], 0.15);
  EXPECT_LT(told["focal_sigma_px"], 2);
  EXPECT_LT(told["baseline_sigma_mm"], 0.2);

  const auto calibration = stereo::read_stereo_calibration(boards.path("head.yaml"), "");
  // 4 sigma, which one of 16,000 is beyond; the corners of a bent picture are off by some
  // hundredths of a pixel in the same way, too.
  const double focal = 4 * told["focal_sigma_px"].get<double>();
  EXPECT_NEAR(calibration.left.fx, kLeftLens.fx, focal);
  EXPECT_NEAR(calibration.right.fy, kRightLens.fy, focal);
  EXPECT_NEAR(calibration.left.cx, kLeftLens.cx, 4 * told["centre_sigma_px"].get<double>());
  EXPECT_NEAR(calibration.right_T_left->translation().norm(), right_T_left().translation().norm(),
              4e-3 * told["baseline_sigma_mm"].get<double>());
  EXPECT_EQ(calibration.width, kAcross);
  EXPECT_TRUE(content_of(cover).starts_with("<svg "));

  const auto check = [&] {
    return run_command({armature(), "check", source_file("configs/dental_lamp_cameras.yaml"),
                        "--set", "rigs.head=" + rig, "--set",
                        "components.pair.params.calibration=" + boards.path("head.yaml").string()});
  };
  const CommandResult unmounted = check();
  EXPECT_EQ(unmounted.exit_code, 3) << unmounted.out;
  EXPECT_THAT(unmounted.err, ContainsRegex("rig.yaml:.*mount"));

  const std::string mount =
      "mount:\n  frame: tool\n  center_mm: [0, -80, 0]\n  forward: [1, 0, 0]\n  right: [0, 0, 1]\n";
  std::ofstream{rig, std::ios::app} << mount;
  ASSERT_EQ(calibrate(boards, {"--board", "9", "6", "--rig", rig}).exit_code, 0);
  EXPECT_THAT(content_of(rig), HasSubstr(mount)) << "where the cameras hang was not measured anew";
  const CommandResult checked = check();
  EXPECT_EQ(checked.exit_code, 0) << checked.err;
  EXPECT_NE(checked.out.find("pair: 640 x 480 pixels"), std::string::npos) << checked.out;
}

TEST(CalibrateStereo, WritesNoFileOverAnotherOneOfItsOwn) {
  const DrawnBoards boards{0};
  for (const char* option : {"--rig", "--coverage"}) {
    const CommandResult result =
        calibrate(boards, {"--board", "9", "6", option, boards.path("left/../head.yaml")});
    EXPECT_EQ(result.exit_code, 3);
    EXPECT_THAT(result.err, HasSubstr("two of -o, --rig and --coverage name '"));
  }
}

TEST(CalibrateStereo, NamesAWriteProtectedOutputBeforeItReadsAPicture) {
  const DrawnBoards boards{0};
  const fs::path rig = boards.path("rig.yaml");
  std::ofstream{rig} << "mount: {frame: tool}\n";
  fs::permissions(rig, fs::perms::owner_read);
  const CommandResult result = calibrate(boards, {"--board", "9", "6", "--rig", rig});
  EXPECT_EQ(result.exit_code, 1);
  EXPECT_THAT(result.err, HasSubstr("rig.yaml': it is write-protected"));
}

TEST(CalibrateStereo, NamesPicturesWithoutTheBoardAndRefusesTooFew) {
  const DrawnBoards boards{1};
  const CommandResult result = calibrate(boards, {"--board", "8", "5"});
  EXPECT_EQ(result.exit_code, 1);
  EXPECT_NE(result.err.find(
                "left out: " + boards.path("left/0.png").string() +
                ": 40 corners are asked for, 8 x 5; the largest grid that is seen has 54, 9 x 6"),
            std::string::npos)
      << result.err;
  EXPECT_NE(result.err.find(
                "0 pairs show the board to both cameras; 3 are the least, 15 or more are good"),
            std::string::npos)
      << result.err;
}

TEST(CalibrateStereo, WritesNothingFromPicturesThatContradictEachOtherAndNamesThem) {
  const DrawnBoards boards{15};
  const std::string rig = boards.path("rig.yaml"), right = boards.path("right/6.png");
  const cv::Mat picture = cv::imread(right, cv::IMREAD_GRAYSCALE);
  const auto refusal = [&] {
    const CommandResult result = calibrate(boards, {"--board", "9", "6", "--rig", rig});
    EXPECT_EQ(result.exit_code, 1);
    EXPECT_EQ(result.out, "");
    EXPECT_FALSE(fs::exists(boards.path("head.yaml")));
    EXPECT_FALSE(fs::exists(rig));
    return result.err;
  };
  fs::rename(right, boards.path("other.png"));
  fs::rename(boards.path("left/6.png"), right);
  fs::rename(boards.path("other.png"), boards.path("left/6.png"));
  EXPECT_THAT(
      refusal(),
      ContainsRegex(
          "the boards of 6.png are up to .* px from where they are seen: .* leave it out\n"));
  fs::rename(right, boards.path("left/6.png"));
  cv::Mat shifted = picture.clone();
  picture.rowRange(8, kDown).copyTo(shifted.rowRange(0, kDown - 8));
  cv::imwrite(right, shifted);
  EXPECT_THAT(refusal(),
              ContainsRegex("nothing is written: .* px rms remain of both cameras together, and .* "
                            "px of each by itself; leave out 6.png\n"));

  fs::remove(right);
  const CommandResult sound = calibrate(boards, {"--board", "9", "6", "--json"});
  ASSERT_EQ(sound.exit_code, 0) << sound.err;
  EXPECT_LT(nlohmann::json::parse(sound.out)["row_error_max_px"], 1);
}

TEST(CalibrateStereo, LeavesOutACopyOfAPicture) {
  const DrawnBoards boards{4};
  fs::copy_file(boards.path("left/1.png"), boards.path("left/9.png"));
  fs::copy_file(boards.path("right/1.png"), boards.path("right/9.png"));
  const CommandResult result = calibrate(boards, {"--board", "9", "6", "--json"});
  EXPECT_THAT(result.err, HasSubstr("left out: 9.png: a picture of it is that of 1.png\n"));
  ASSERT_EQ(result.exit_code, 0) << result.err;
  EXPECT_EQ(nlohmann::json::parse(result.out)["pairs_used"], 4);
}

TEST(CalibrateStereo, RefusesAFolderThatIsNotThere) {
  const DrawnBoards boards{0};
  fs::remove(boards.path("left"));
  const CommandResult result = calibrate(boards, {"--board", "9", "6"});
  EXPECT_EQ(result.exit_code, 3);
  EXPECT_NE(
      result.err.find("left: the folder '" + boards.path("left").string() + "' cannot be read"),
      std::string::npos)
      << result.err;
  EXPECT_FALSE(fs::exists(boards.path("head.yaml")));
}

TEST(CalibrateStereo, RefusesASquareWithoutASize) {
  const CommandResult result =
      run_command({armature(), "calibrate", "stereo", "--square-mm", "nan", "--left", "here",
                   "--right", "here", "--board", "9", "6", "-o", "head.yaml"});
  EXPECT_EQ(result.exit_code, 2) << result.out;
  EXPECT_NE(result.err.find("--square-mm"), std::string::npos) << result.err;
}

}  // namespace
}  // namespace armature::test
