// SPDX-License-Identifier: Apache-2.0
// 1. Of points that two bent and crooked cameras see, the pair shows rows that agree, and its
// camera infos triangulate them. 2. Pictures that are no pair are refused, counted, and told. 3. A
// calibration and a rig that do not belong together are refused before the run.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <cmath>
#include <filesystem>
#include <fstream>

#include "armature/messages/armature_msgs.hpp"
#include "armature/messages/header.hpp"
#include "armature/messages/sensor_msgs.hpp"
#include "armature/robot/geometry/rotation.hpp"
#include "armature/runtime/testing/component_harness.hpp"
#include "armature/runtime/testing/test_plugins.hpp"
#include "armature/values/temporary_folder.hpp"
#include "rectification.hpp"

namespace armature::camera::stereo_pair {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;

constexpr int kWidth = 640, kHeight = 480;

const stereo::Lens kLeft{.fx = 520,
                         .fy = 523,
                         .cx = 316,
                         .cy = 236,
                         .distortion = {-0.22, 0.07, 0.0012, -0.0008, -0.004}};
const stereo::Lens kRight{
    .fx = 528, .fy = 526, .cx = 325, .cy = 247, .distortion = {-0.2, 0.06, -0.001, 0.0011, 0.002}};

Eigen::Isometry3d right_T_left() {
  Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
  pose.linear() = rotation_from_rpy({0.02, -0.03, 0.012});
  pose.translation() = Vector3d{-0.118, 0.002, -0.003};
  return pose;
}

std::string matrix(const std::string& name, const Eigen::MatrixXd& m) {
  std::string data;
  for (const double number : m.reshaped<Eigen::RowMajor>()) {
    data += (data.empty() ? "" : ", ") + fmt::format("{:.17g}", number);
  }
  return fmt::format("{}: !!opencv-matrix\n   rows: {}\n   cols: {}\n   dt: d\n   data: [ {} ]\n",
                     name, m.rows(), m.cols(), data);
}

std::string calibration(double unit_per_m = 1) {
  std::string text = "%YAML:1.0\n---\nimage_width: 640\nimage_height: 480\n";
  for (const auto& [number, lens] : {std::pair{"1", &kLeft}, {"2", &kRight}}) {
    Eigen::Matrix3d k;
    k << lens->fx, 0, lens->cx, 0, lens->fy, lens->cy, 0, 0, 1;
    text += matrix(std::string{"M"} + number, k);
    text += matrix(std::string{"D"} + number,
                   Eigen::Map<const Eigen::Matrix<double, 1, 5>>{lens->distortion.data()});
  }
  return text + matrix("R", right_T_left().linear()) +
         matrix("T", unit_per_m * right_T_left().translation());
}

msg::Image picture(Time stamp, std::uint8_t grey = 0) {
  msg::Image image;
  write_header(image.header_(), stamp, "camera");
  image.encoding_() = "mono8";
  image.width_() = image.step_() = kWidth;
  image.height_() = kHeight;
  image.data_().assign(kWidth * kHeight, grey);
  return image;
}

/// Adds a round spot of 3 px to a picture.
void draw_spot(msg::Image& image, const Vector2d& at) {
  for (int v = 0; v < kHeight; ++v) {
    for (int u = 0; u < kWidth; ++u) {
      const double distance = (Vector2d{u, v} - at).squaredNorm() / (2 * 3.0 * 3.0);
      if (distance > 12) continue;
      auto& pixel = image.data_()[static_cast<std::size_t>(v * kWidth + u)];
      pixel = static_cast<std::uint8_t>(
          std::min<long>(255, pixel + std::lround(250 * std::exp(-distance))));
    }
  }
}

/// The middle of the spot near `about`.
Vector2d spot(const msg::Image& image, const Vector2d& about) {
  Vector2d sum = Vector2d::Zero();
  double weight = 0;
  for (int v = 0; v < kHeight; ++v) {
    for (int u = 0; u < kWidth; ++u) {
      if ((Vector2d{u, v} - about).norm() > 14) continue;
      const double grey = image.data_()[static_cast<std::size_t>(v * kWidth + u)];
      sum += grey * Vector2d{u, v};
      weight += grey;
    }
  }
  return sum / weight;
}

/// The point that both projection matrices see there: the least squares solution of four lines
/// (Hartley and Zisserman, Multiple View Geometry, 12.2).
Vector3d triangulated(const msg::CameraInfo& left, const msg::CameraInfo& right,
                      const Vector2d& at_left, const Vector2d& at_right) {
  Eigen::Matrix4d lines;
  int row = 0;
  for (const auto& [info, at] : {std::pair{&left, at_left}, {&right, at_right}}) {
    const Eigen::Matrix<double, 3, 4> p =
        Eigen::Map<const Eigen::Matrix<double, 3, 4, Eigen::RowMajor>>{info->p_().data()};
    lines.row(row++) = at.x() * p.row(2) - p.row(0);
    lines.row(row++) = at.y() * p.row(2) - p.row(1);
  }
  return lines.leftCols<3>().colPivHouseholderQr().solve(-lines.col(3));
}

class StereoPairTest : public testing::Test {
 protected:
  StereoPairTest() { std::ofstream{file_} << calibration(); }

  ComponentHarness::Options options(const std::string& more = "",
                                    const std::string& rig = "") const {
    ComponentHarness::Options made{
        .component =
            "{plugin: camera/stereo_pair, params: {calibration: " + file_.string() + more + "}}",
        .robot = {}};
    if (!rig.empty()) made.rig = config::parse_text(rig, "rig.yaml");
    return made;
  }
  static bool is_well(const ComponentHarness& pair) {
    return pair.status().state == StatusReporter::State::ok;
  }
  static void send(ComponentHarness& pair, double left_s, double right_s) {
    pair.send("left_raw", picture(Time{} + seconds(left_s)));
    pair.send("right_raw", picture(Time{} + seconds(right_s)));
  }
  const TemporaryFolder folder_;
  const std::filesystem::path file_ = folder_ / "stereo.yaml";
};

TEST_F(StereoPairTest, ShowsPointsInTheSameRowsAndItsInfosTriangulateThem) {
  const std::vector<Vector3d> points{{0, 0, 0.8},        {-0.25, -0.15, 0.8}, {0.25, 0.15, 0.8},
                                     {-0.2, 0.18, 0.7},  {0.3, -0.2, 0.9},    {0.1, 0.1, 0.5},
                                     {-0.05, -0.2, 0.6}, {0.02, 0.25, 0.9}};
  msg::Image left = picture(Time{} + seconds(1)), right = picture(Time{} + seconds(1.002));
  for (const Vector3d& point : points) {
    draw_spot(left, kLeft.project(point.hnormalized()));
    draw_spot(right, kRight.project((right_T_left() * point).hnormalized()));
  }
  ComponentHarness pair{built_plugins(), options()};
  pair.send("left_raw", left);
  pair.send("right_raw", right);
  EXPECT_TRUE(pair.triggered());
  pair.step(1.01);
  const auto lefts = pair.take<msg::Image>("left_image"),
             rights = pair.take<msg::Image>("right_image");
  const auto left_info = pair.take<msg::CameraInfo>("left_info"),
             right_info = pair.take<msg::CameraInfo>("right_info");
  ASSERT_EQ(lefts.size(), 1U);
  ASSERT_EQ(rights.size(), 1U);
  ASSERT_EQ(left_info.size(), 1U);
  ASSERT_EQ(right_info.size(), 1U);
  EXPECT_EQ(stamp_of(lefts[0].header_().stamp_()), Time{} + seconds(1.001));
  EXPECT_EQ(lefts[0].header_(), rights[0].header_());
  EXPECT_EQ(lefts[0].header_().frame_id_(), "left_camera_optical");

  stereo::StereoCalibration known{
      .width = kWidth, .height = kHeight, .left = kLeft, .right = kRight};
  known.right_T_left = right_T_left();
  const auto made = stereo::rectification_of(known).value();
  for (const Vector3d& point : points) {
    const Vector3d expected = made.rectified_R_left * point;
    const Vector2d at_left = made.camera.project_left(expected);
    const Vector2d at_right = made.camera.project_right(expected);
    // The infos of the exact pixels give the point exactly.
    EXPECT_LT((triangulated(left_info[0], right_info[0], at_left, at_right) - expected).norm(),
              1e-9);
    // Pictures have their spots there, to a fraction of a pixel.
    const Vector2d seen_left = spot(lefts[0], at_left), seen_right = spot(rights[0], at_right);
    EXPECT_LT((seen_left - at_left).norm(), 0.05) << point.transpose();
    EXPECT_LT((seen_right - at_right).norm(), 0.05) << point.transpose();
    EXPECT_NEAR(seen_left.y(), seen_right.y(), 0.05) << point.transpose();
    // 0.1 px of disparity are z^2 / (f b) times as much in depth.
    const double z = expected.z(),
                 depth_error = 0.1 * z * z / (made.camera.focal_px * made.camera.baseline_m);
    EXPECT_LT((triangulated(left_info[0], right_info[0], seen_left, seen_right) - expected).norm(),
              1.2 * depth_error)
        << point.transpose();
  }
}

TEST_F(StereoPairTest, TellsItsIntrinsicsOnceAndHowMuchOfThePicturesIsSeen) {
  ComponentHarness pair{built_plugins(), options()};
  for (int i = 0; i < 3; ++i) {
    send(pair, 1 + i, 1 + i);
    pair.step(1 + i);
  }
  EXPECT_EQ(pair.take<msg::CameraInfo>("left_info").size(), 1U);
  EXPECT_EQ(pair.take<msg::Image>("right_image").size(), 3U);
  const auto notes = pair.component().notes_for_check();
  ASSERT_EQ(notes.size(), 1U);
  EXPECT_NE(notes[0].find(
                "640 x 480 pixels, f 524.2 px, baseline 118.06 mm; the left camera is turned by"),
            std::string::npos)
      << notes[0];
}

TEST_F(StereoPairTest, PicturesTooFarApartAreRefusedCountedAndTold) {
  ComponentHarness pair{built_plugins(), options(", max_skew_ms: 4")};
  send(pair, 1, 1.003);
  pair.step(1.01);
  EXPECT_TRUE(is_well(pair));
  send(pair, 1.1, 1.106);
  pair.step(1.11);
  send(pair, 1.2, 1.206);
  pair.step(1.21);
  EXPECT_FALSE(is_well(pair));
  EXPECT_EQ(pair.lines().back(),
            "pictures without a partner within max_skew_ms (4): 1; the last one's nearest is 6.0 "
            "ms away");
  send(pair, 1.3, 1.3);
  pair.step(1.31);
  EXPECT_FALSE(is_well(pair)) << "a second long";
  send(pair, 2.3, 2.3);
  pair.step(2.31);
  EXPECT_TRUE(is_well(pair));
  EXPECT_EQ(pair.take<msg::Image>("left_image").size(), 3U);
  const auto metrics = pair.figures().metrics;
  EXPECT_EQ(metrics.at("pairs"), 3);
  EXPECT_EQ(metrics.at("unpaired_pictures"), 4);
  EXPECT_NEAR(metrics.at("max_pair_skew_ms"), 3, 1e-9);
}

TEST_F(StereoPairTest, ACameraThatIsSilentIsNamedUntilItIsHeardAgain) {
  ComponentHarness pair{built_plugins(), options(", timeout_s: 0.5")};
  pair.step(0);
  EXPECT_TRUE(is_well(pair));
  pair.send("left_raw", picture(Time{} + seconds(0.4)));
  pair.step(0.4);
  pair.step(0.6);
  EXPECT_EQ(pair.lines().back(), "no picture of the right camera for 0.5 s");
  EXPECT_FALSE(is_well(pair));
  for (const double now : {0.7, 1.1, 1.5, 1.9}) {
    send(pair, now, now);
    pair.step(now);
  }
  EXPECT_TRUE(is_well(pair));
}

TEST_F(StereoPairTest, WhileCaptureIsOffThereAreNoPairsAndNobodyMissesThem) {
  ComponentHarness pair{built_plugins(), options(", timeout_s: 0.5")};
  msg::Capture capture;
  capture.on_() = false;
  pair.send("capture", capture);
  send(pair, 0.1, 0.1);
  pair.step(0.1);
  pair.step(3);
  EXPECT_TRUE(is_well(pair));
  EXPECT_TRUE(pair.take<msg::Image>("left_image").empty());
  EXPECT_EQ(pair.figures().metrics.at("unpaired_pictures"), 0);
  capture.on_() = true;
  pair.send("capture", capture);
  send(pair, 3.1, 3.1);
  pair.step(3.1);
  EXPECT_EQ(pair.take<msg::Image>("left_image").size(), 1U);
  pair.step(3.7);
  EXPECT_FALSE(is_well(pair));
}

TEST_F(StereoPairTest, ACameraThatWasSilentBeforeCaptureWentOffStaysNamedUntilItIsHeard) {
  ComponentHarness pair{built_plugins(), options(", timeout_s: 0.5")};
  send(pair, 0.1, 0.1);
  pair.step(0.1);
  pair.step(1);
  ASSERT_FALSE(is_well(pair));
  msg::Capture capture;
  capture.on_() = false;
  pair.send("capture", capture);
  pair.step(1.1);
  pair.step(3);
  EXPECT_FALSE(is_well(pair)) << "nobody asks now, and the cable is out all the same";
  for (const double now : {3.1, 3.5, 3.9, 4.3}) {
    send(pair, now, now);
    pair.step(now);
  }
  EXPECT_TRUE(is_well(pair));
}

TEST_F(StereoPairTest, PicturesOfAnotherSizeOrEncodingAreRefusedCountedAndTold) {
  ComponentHarness pair{built_plugins(), options()};
  msg::Image small = picture(Time{} + seconds(1));
  small.height_() = 400;
  pair.send("left_raw", small);
  pair.send("right_raw", picture(Time{} + seconds(1)));
  pair.step(1);
  EXPECT_EQ(pair.lines().back(),
            "the left picture has 640 x 400 pixels, and the calibration is of 640 x 480; pairs "
            "refused: 1");
  msg::Image colour = picture(Time{} + seconds(3));
  colour.encoding_() = "rgb8";
  pair.send("left_raw", picture(Time{} + seconds(3)));
  pair.send("right_raw", colour);
  pair.step(3);
  EXPECT_EQ(pair.lines().back(), "right: the image is 'rgb8', not mono8; pairs refused: 2");
  EXPECT_TRUE(pair.take<msg::Image>("left_image").empty());
  EXPECT_EQ(pair.figures().metrics.at("refused_pairs"), 2);
}

TEST_F(StereoPairTest, ARefusalIsToldWithItsReasonForASecondWhateverPairsCome) {
  ComponentHarness pair{built_plugins(), options()};
  const auto send_small = [&](double at_s) {
    msg::Image small = picture(Time{} + seconds(at_s));
    small.height_() = 400;
    pair.send("left_raw", small);
    pair.send("right_raw", picture(Time{} + seconds(at_s)));
  };
  for (const double now : {1.0, 1.9}) {
    send_small(now);
    pair.step(now);
  }
  send(pair, 2.05, 2.05);
  pair.step(2.05);
  EXPECT_FALSE(is_well(pair)) << "a second long";
  EXPECT_EQ(pair.status().reason,
            "the left picture has 640 x 400 pixels, and the calibration is of 640 x 480; pairs "
            "refused: 2");
  EXPECT_EQ(pair.take<msg::Image>("left_image").size(), 1U);
  send(pair, 2.95, 2.95);
  pair.step(2.95);
  EXPECT_TRUE(is_well(pair));
}

constexpr const char* kRig =
    "{armature_rig: 1, name: head, resolution: [640, 480], focal_px: 524.25, principal_point_px: "
    "[319.2, 241.3], baseline_mm: 118.06, mount: {frame: tool, forward: [1, 0, 0], right: [0, 0, "
    "1]}}";

TEST_F(StereoPairTest, WithoutACalibrationTheRigSaysThePairAndThePicturesStayAsTheyAre) {
  ComponentHarness pair{built_plugins(),
                        {.component = "{plugin: camera/stereo_pair}",
                         .robot = {},
                         .rig = config::parse_text(kRig, "rig.yaml")}};
  msg::Image left = picture(Time{} + seconds(1), 5);
  left.data_()[1234] = 200;
  pair.send("left_raw", left);
  pair.send("right_raw", picture(Time{} + seconds(1), 7));
  pair.step(1);
  EXPECT_EQ(pair.take<msg::Image>("left_image").at(0).data_(), left.data_());
  const auto info = pair.take<msg::CameraInfo>("right_info").at(0);
  EXPECT_EQ(info.p_()[0], 524.25);
  EXPECT_NEAR(info.p_()[3], -524.25 * 0.11806, 1e-12);
}

TEST_F(StereoPairTest, ARigThatSaysAnotherPairIsRefusedWithTheNumbersThatItNeeds) {
  const std::string rig = kRig;
  EXPECT_NE(
      refusal_of(built_plugins(),
                 options("", std::string{rig}.replace(rig.find("118.06"), 6, "120.50")))
          .find("the calibration gives another pair of cameras than the rig 'head'; write into the "
                "rig resolution: [640, 480], focal_px: 524.250,"),
      std::string::npos);
}

TEST_F(StereoPairTest, ACalibrationThatSaysNoSizeIsAskedForThatOfTheRig) {
  std::string text = calibration();
  const std::string size = "image_width: 640\nimage_height: 480\n";
  text.erase(text.find(size), size.size());
  std::ofstream{file_} << text.replace(text.find("316"), 3, "632");
  const std::string refusal = refusal_of(built_plugins(), options("", kRig));
  EXPECT_NE(refusal.find("the principal point (632, 236) of 'M1' is far from the middle of "
                         "pictures of 640 x 480 pixels; was it calibrated at another size?"),
            std::string::npos)
      << refusal;
}

TEST_F(StereoPairTest, ACalibrationThatCannotBeUsedIsRefusedWithItsFile) {
  EXPECT_NE(refusal_of(built_plugins(), {.component = "{plugin: camera/stereo_pair}", .robot = {}})
                .find("neither a calibration nor a rig says what the cameras are"),
            std::string::npos);
  std::ofstream{file_} << calibration(1000);
  const std::string in_mm = refusal_of(built_plugins(), options());
  EXPECT_NE(in_mm.find("calibration: " + file_.string() + ": the cameras stand 118.055 m apart"),
            std::string::npos)
      << in_mm;
  EXPECT_EQ(refusal_of(built_plugins(), options(", calibration_unit: mm")), "");
  std::ofstream{file_} << "M1: 3\n";
  const std::string wrong = refusal_of(built_plugins(), options());
  EXPECT_NE(wrong.find(file_.string() + ":1:5: 'M1' must be a matrix"), std::string::npos) << wrong;
}

}  // namespace
}  // namespace armature::camera::stereo_pair
