// SPDX-License-Identifier: Apache-2.0
// 1. Files as OpenCV's FileStorage and ROS' camera_calibration write them. 2. What is wrong in one
// is told all at once, with line and column.
#include "calibration_file.hpp"

#include <gtest/gtest.h>

#include <fstream>

#include "armature/config/problems.hpp"
#include "armature/values/temporary_folder.hpp"
#include "rectification.hpp"

namespace armature::stereo {
namespace {

const std::string kOpenCv = R"(%YAML:1.0
---
M1: !!opencv-matrix
   rows: 3
   cols: 3
   dt: d
   data: [ 5.3500000000000000e+02, 0., 3.2000000000000000e+02, 0.,
       5.3600000000000000e+02, 2.4000000000000000e+02, 0., 0., 1. ]
D1: !!opencv-matrix
   rows: 1
   cols: 5
   dt: d
   data: [ -2.5e-01, -2.5e-02, 1.5e-03, -5.0e-04, 2.0e-01 ]
M2: !!opencv-matrix
   rows: 3
   cols: 3
   dt: d
   data: [ 537., 0., 325., 0., 538., 250., 0., 0., 1. ]
D2: !!opencv-matrix
   rows: 1
   cols: 14
   dt: d
   data: [ -0.25, 0.1, 0., 0., 0.01, 0.02, 0.03, 0.04, 0., 0., 0., 0., 0., 0. ]
R: !!opencv-matrix
   rows: 3
   cols: 3
   dt: d
   data: [ 1., 0., 0., 0., 1., 0., 0., 0., 1. ]
T: !!opencv-matrix
   rows: 3
   cols: 1
   dt: d
   data: [ -60., 0., 0. ]
image_width: 640
image_height: 480
)";
const std::string kOpenCvRectification = R"(R1: !!opencv-matrix
   rows: 3
   cols: 3
   dt: d
   data: [ 1., 0., 0., 0., 1., 0., 0., 0., 1. ]
R2: !!opencv-matrix
   rows: 3
   cols: 3
   dt: d
   data: [ 1., 0., 0., 0., 1., 0., 0., 0., 1. ]
P1: !!opencv-matrix
   rows: 3
   cols: 4
   dt: d
   data: [ 500., 0., 310., 0., 0., 500., 230., 0., 0., 0., 1., 0. ]
P2: !!opencv-matrix
   rows: 3
   cols: 4
   dt: d
   data: [ 500., 0., 310., -30000., 0., 500., 230., 0., 0., 0., 1., 0. ]
)";

std::string ros(const std::string& name, const std::string& p3) {
  return R"(image_width: 640
image_height: 480
camera_name: )" +
         name + R"(
camera_matrix:
  rows: 3
  cols: 3
  data: [535, 0, 320, 0, 536, 240, 0, 0, 1]
distortion_model: plumb_bob
distortion_coefficients:
  rows: 1
  cols: 5
  data: [-0.25, -0.025, 0.0015, -0.0005, 0]
rectification_matrix:
  rows: 3
  cols: 3
  data: [0.999987, 0.005, 0, -0.005, 0.999987, 0, 0, 0, 1]
projection_matrix:
  rows: 3
  cols: 4
  data: [500, 0, 310, )" +
         p3 + ", 0, 500, 230, 0, 0, 0, 1, 0]\n";
}

/// `text` with words replaced, each of which must be there.
std::string edited(std::string text,
                   const std::vector<std::pair<std::string, std::string>>& replacements) {
  for (const auto& [of, by] : replacements) {
    const auto at = text.find(of);
    EXPECT_NE(at, std::string::npos) << of;
    if (at != std::string::npos) text.replace(at, of.size(), by);
  }
  return text;
}

class CalibrationFileTest : public testing::Test {
 protected:
  StereoCalibration read(const std::string& text, double unit_m = 0.001) const {
    std::ofstream{left_} << text;
    return read_stereo_calibration(left_, "", unit_m);
  }
  StereoCalibration read_both(const std::string& left, const std::string& right) const {
    std::ofstream{left_} << left;
    std::ofstream{right_} << right;
    return read_stereo_calibration(left_, right_);
  }
  /// What is wrong, without the names of the files.
  template <class Read>
  std::string problems(Read read) const {
    try {
      read();
    } catch (const config::ConfigError& error) {
      std::string text;
      for (const auto& problem : error.problems()) {
        const auto& [file, line, column] = problem.origin;
        text += (file == right_ ? "right:" : "") + std::to_string(line) + ":" +
                std::to_string(column) + ": " + problem.message + "\n";
      }
      return text;
    }
    return "";
  }
  std::string problems_of(const std::string& text) const {
    return problems([&] { read(text); });
  }
  const TemporaryFolder folder_;
  const std::filesystem::path left_ = folder_ / "left.yaml", right_ = folder_ / "right.yaml";
};

TEST_F(CalibrationFileTest, ReadsOpenCvsFileOfBothCameras) {
  const StereoCalibration read_file = read(kOpenCv);
  EXPECT_EQ(read_file.width, 640);
  EXPECT_EQ(read_file.height, 480);
  EXPECT_EQ(read_file.left.fx, 535);
  EXPECT_EQ(read_file.left.fy, 536);
  EXPECT_EQ(read_file.left.cx, 320);
  EXPECT_EQ(read_file.left.cy, 240);
  EXPECT_EQ(read_file.left.distortion,
            (std::array<double, 8>{-0.25, -0.025, 0.0015, -0.0005, 0.2, 0, 0, 0}));
  EXPECT_EQ(read_file.right.distortion,
            (std::array<double, 8>{-0.25, 0.1, 0, 0, 0.01, 0.02, 0.03, 0.04}));
  EXPECT_TRUE(read_file.right_T_left->translation().isApprox(Eigen::Vector3d{-0.06, 0, 0}));
  EXPECT_FALSE(read_file.rectification);
  EXPECT_NEAR(rectification_of(read_file)->camera.baseline_m, 0.06, 1e-12);
}

TEST_F(CalibrationFileTest, KeepsTheRectificationThatOpenCvsFileSays) {
  const StereoCalibration both = read(kOpenCv + kOpenCvRectification);
  ASSERT_TRUE(both.rectification);
  const StereoCamera camera = rectification_of(both)->camera;
  EXPECT_EQ(camera.focal_px, 500);
  EXPECT_EQ(camera.cx, 310);
  EXPECT_EQ(camera.cy, 230);
  EXPECT_NEAR(camera.baseline_m, 0.06, 1e-15);
  EXPECT_EQ(camera.width, 640);
}

TEST_F(CalibrationFileTest, ReadsTheFilesOfRosOneOfEachCamera) {
  const StereoCalibration pair = read_both(ros("left", "0"), ros("right", "-30"));
  EXPECT_EQ(pair.width, 640);
  EXPECT_EQ(pair.left.fx, 535);
  EXPECT_FALSE(pair.right_T_left);
  ASSERT_TRUE(pair.rectification);
  EXPECT_NEAR(pair.rectification->camera.baseline_m, 0.06, 1e-15);
  EXPECT_TRUE(
      (pair.rectification->rectified_R_left * pair.rectification->rectified_R_left.transpose())
          .isIdentity(1e-14))
      << "rounded numbers are made a rotation";
}

TEST_F(CalibrationFileTest, TellsAllThatIsWrongWithLineAndColumn) {
  EXPECT_EQ(problems_of(edited(kOpenCv, {{"0., 3.2000000000000000e+02", "0.5, 320."},
                                         {"325., 0.", "1325., 0."},
                                         {"-2.5e-01, ", ""},
                                         {"R: !!opencv-matrix", "Rotation: !!opencv-matrix"},
                                         {"-60., 0., 0.", "-60., .nan, 0."}})),
            "3:1: missing 'R', a matrix: {rows: .., cols: .., data: [..]}\n"
            "13:10: 'data' of 'D1' (1 x 5) must be a list of 5 numbers, not of 4\n"
            "15:4: the principal point (1325, 250) of 'M2' is far from the middle of pictures "
            "of 640 x 480 pixels; was it calibrated at another size?\n"
            "33:18: 'data' of 'T' (3 x 1) must be a list of 3 numbers; item 2 must be a number, "
            "not '.nan'; it must be finite\n");
  EXPECT_EQ(problems_of(edited(kOpenCv, {{"image_width: 640", "image_width: wide"},
                                         {"0., 0., 0., 0., 0., 0. ]", "0., 0., 0., 0., 0., 1. ]"},
                                         {"[ 1., 0., 0., 0., 1.", "[ 1.1, 0., 0., 0., 1."},
                                         {"rows: 3\n   cols: 1", "rows: 1\n   cols: 3"}})),
            "20:4: 'D2' has 14 coefficients; known are k1, k2, p1, p2, of which k3 and then k4, "
            "k5, k6 may follow: 4, 5 or 8, and zeros behind them\n"
            "25:4: 'R' is no rotation: its numbers are up to 0.1 off the nearest one\n"
            "30:4: 'T' is 1 x 3, not 3 x 1\n"
            "34:14: 'image_width' must be a number of pixels from 1 to 16384, not 'wide'\n");
}

TEST_F(CalibrationFileTest, AsksForTheSizeAtWhichAPrincipalPointIsNotInTheMiddle) {
  const std::string larger = edited(kOpenCv, {{"image_width: 640", "image_width: 1280"},
                                              {"image_height: 480", "image_height: 720"}});
  EXPECT_EQ(problems_of(larger),
            "4:4: the principal point (320, 240) of 'M1' is far from the middle of pictures of "
            "1280 x 720 pixels; was it calibrated at another size?\n"
            "15:4: the principal point (325, 250) of 'M2' is far from the middle of pictures of "
            "1280 x 720 pixels; was it calibrated at another size?\n");
}

TEST_F(CalibrationFileTest, NamesProjectionsThatAreOfNoRectifiedPair) {
  const std::string all = kOpenCv + kOpenCvRectification;
  EXPECT_EQ(problems_of(edited(all, {{"310., -30000.", "311., -30000."}})),
            "52:4: 'P1' and 'P2' are of no rectified pair: cx is 310 and 311 px; rectify with "
            "CALIB_ZERO_DISPARITY\n");
  EXPECT_EQ(problems_of(edited(all, {{"-30000.", "30000."}})),
            "52:4: 'P1' and 'P2' are of no rectified pair: P[3] is 0 on the left, where it must be "
            "0, and 30000 on the right, where it must be -f b; are left and right exchanged?\n");
  EXPECT_EQ(problems_of(edited(all, {{"[ 500., 0., 310., 0., 0., 500., 230.",
                                      "[ 500., 0., 310., 0., 0., 500., 231."}})),
            "52:4: 'P1' and 'P2' are of no rectified pair: their rows do not agree; cameras one "
            "above the other are not read\n");
  EXPECT_EQ(problems_of(edited(all, {{"-30000., 0., 500.", "-30000., 0., 510."}})),
            "52:4: 'P1' and 'P2' are of no rectified pair: the focal lengths 500, 500, 500, 510 px "
            "differ\n");
  EXPECT_EQ(problems_of(edited(all, {{"R2: ", "Q2: "}})),
            "3:1: missing 'R2', a matrix: {rows: .., cols: .., data: [..]}\n");
}

TEST_F(CalibrationFileTest, SaysWhichFileOfRosIsWrongAndWhatItIs) {
  EXPECT_EQ(problems([&] {
              read_both(ros("left", "0"),
                        edited(ros("right", "-30"),
                               {{"height: 480", "height: 481"}, {"plumb_bob", "equidistant"}}));
            }),
            "right:1:14: the right pictures have 640 x 481 pixels, the left ones 640 x 480\n"
            "right:8:19: the distortion model 'equidistant' is not read; known are plumb_bob and "
            "rational_polynomial\n");
  EXPECT_EQ(problems([&] { read(ros("left", "0")); }),
            "1:1: is of one camera; say the right one's file, too (right_calibration)\n");
  EXPECT_EQ(problems([&] { read_both(kOpenCv, ros("right", "0")); }),
            "3:1: has no 'camera_matrix' and is not ROS' file of one camera; a file of both "
            "cameras needs no second one (right_calibration)\n");
}

TEST_F(CalibrationFileTest, RefusesWhatIsNoCalibration) {
  EXPECT_EQ(problems_of("armature_rig: 1\n"),
            "1:1: is no calibration of two cameras: it has neither 'M1' (OpenCV) nor "
            "'camera_matrix' (ROS, one file of each camera)\n");
  EXPECT_EQ(problems_of("<?xml version=\"1.0\"?>\n"),
            "1:1: is XML; have OpenCV write a name that ends in .yaml\n");
  EXPECT_NE(problems([&] { read_stereo_calibration("/gone.yaml", ""); }), "");
}

}  // namespace
}  // namespace armature::stereo
