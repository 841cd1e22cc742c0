// SPDX-License-Identifier: Apache-2.0
// Two cameras that are known exactly look at points that are known exactly: 1. after rectification
// both see a point in the same row, and the pair triangulates it, whether the rectification is made
// here or said by the file. 2. What is no pair is refused with its numbers.
#include "rectification.hpp"

#include <gtest/gtest.h>

#include <random>

#include "armature/robot/geometry/rotation.hpp"

namespace armature::stereo {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;

/// Two lenses that bend, 120 mm apart and turned by a few degrees against each other.
StereoCalibration crooked_pair() {
  StereoCalibration pair{
      .width = 1280,
      .height = 720,
      .left = {.fx = 905,
               .fy = 908,
               .cx = 631,
               .cy = 352,
               .distortion = {-0.21, 0.06, 0.0011, -0.0007, -0.004}},
      .right = {.fx = 921,
                .fy = 919,
                .cx = 648,
                .cy = 371,
                .distortion = {-0.19, 0.05, -0.0009, 0.0012, 0.001, 0.02, -0.01, 0.001}}};
  pair.right_T_left.emplace(Eigen::Isometry3d::Identity());
  pair.right_T_left->linear() = rotation_from_rpy({0.021, -0.034, 0.015});
  pair.right_T_left->translation() = Vector3d{-0.1193, 0.0021, -0.0034};
  return pair;
}

/// Where a rectified picture has what a camera has at `pixel`.
Vector2d rectified(const Rectification& made, const Eigen::Matrix3d& rectified_R_camera,
                   const Lens& lens, const Vector2d& pixel) {
  const auto ray = lens.ray_of(pixel);
  EXPECT_TRUE(ray) << pixel.transpose();
  const Vector2d seen = (rectified_R_camera * ray->homogeneous()).hnormalized();
  return made.camera.focal_px * seen + Vector2d{made.camera.cx, made.camera.cy};
}

void expect_exact(const StereoCalibration& pair, const Eigen::Isometry3d& right_T_left) {
  const auto made = rectification_of(pair);
  ASSERT_TRUE(made) << made.error().text;
  constexpr std::uint64_t kSeed = 7;
  SCOPED_TRACE("seed " + std::to_string(kSeed));
  std::mt19937_64 random{kSeed};
  std::uniform_real_distribution<double> aside{-0.5, 0.5}, away{0.3, 2};
  for (int i = 0; i < 2000; ++i) {
    const double z = away(random);
    const Vector3d left_p{aside(random) * z, 0.5 * aside(random) * z, z};
    const Vector3d right_p = right_T_left * left_p;
    const Vector2d raw_left = pair.left.project(left_p.hnormalized());
    const Vector2d raw_right = pair.right.project(right_p.hnormalized());
    const Vector2d left = rectified(*made, made->rectified_R_left, pair.left, raw_left);
    const Vector2d right = rectified(*made, made->rectified_R_right, pair.right, raw_right);
    ASSERT_NEAR(left.y(), right.y(), 1e-6) << "the lenses' rays are known to 1e-12";
    const Vector3d expected = made->rectified_R_left * left_p;
    ASSERT_LT((made->camera.triangulate(left, right) - expected).norm(), 1e-7 * z * z);
    const auto back = raw_pixel(made->camera, made->rectified_R_right, pair.right,
                                pair.right.max_radius(), right);
    ASSERT_TRUE(back);
    ASSERT_LT((*back - raw_right).norm(), 1e-8);
  }
}

TEST(Rectification, HalfWayPutsPointsIntoTheSameRowsAndTriangulatesThem) {
  const StereoCalibration pair = crooked_pair();
  expect_exact(pair, *pair.right_T_left);
}

TEST(Rectification, ThatTheFileSaysIsKeptAndAsExact) {
  const StereoCalibration pair = crooked_pair();
  StereoCalibration said = pair;
  said.rectification = rectification_of(pair).value();
  // Any other turn about the baseline, and any other pinhole, is a rectification, too.
  const Eigen::Matrix3d tilt = rotation_from_rpy({0.05, 0, 0});
  said.rectification->rectified_R_left = tilt * said.rectification->rectified_R_left;
  said.rectification->rectified_R_right = tilt * said.rectification->rectified_R_right;
  said.rectification->camera.focal_px = 800;
  said.rectification->camera.cx = 600;
  said.rectification->camera.cy = 333;
  expect_exact(said, *pair.right_T_left);
  EXPECT_EQ(rectification_of(said)->camera.focal_px, 800);
  EXPECT_EQ(rectification_of(said)->camera.width, 1280);
}

TEST(Rectification, OfStraightCamerasChangesNothing) {
  const Lens lens{.fx = 914, .fy = 914, .cx = 639.5, .cy = 359.5};
  StereoCalibration pair{.width = 1280, .height = 720, .left = lens, .right = lens};
  pair.right_T_left = Eigen::Isometry3d{Eigen::Translation3d{-0.12, 0, 0}};
  const auto made = rectification_of(pair);
  ASSERT_TRUE(made);
  EXPECT_TRUE(made->rectified_R_left.isIdentity(1e-15));
  EXPECT_TRUE(made->rectified_R_right.isIdentity(1e-15));
  EXPECT_EQ(made->camera.focal_px, 914);
  EXPECT_NEAR(made->camera.cx, 639.5, 1e-9);
  EXPECT_NEAR(made->camera.cy, 359.5, 1e-9);
  EXPECT_NEAR(made->camera.baseline_m, 0.12, 1e-15);
}

TEST(Rectification, ShowsInTheMiddleWhatTheCamerasHaveThere) {
  const StereoCalibration pair = crooked_pair();
  const auto made = rectification_of(pair).value();
  const Vector2d left = rectified(made, made.rectified_R_left, pair.left, {639.5, 359.5});
  const Vector2d right = rectified(made, made.rectified_R_right, pair.right, {639.5, 359.5});
  EXPECT_NEAR(0.5 * (left.x() + right.x()), 639.5, 10) << "the lenses are not quite symmetric";
  EXPECT_NEAR(0.5 * (left.y() + right.y()), 359.5, 10);
}

TEST(Rectification, OfWhatIsNoPairIsRefusedWithItsNumbers) {
  const auto refusal = [](const StereoCalibration& pair) {
    const auto made = rectification_of(pair);
    return made ? "" : made.error().text;
  };
  const auto moved = [](const Vector3d& translation) {
    StereoCalibration pair = crooked_pair();
    pair.right_T_left = Eigen::Isometry3d{Eigen::Translation3d{translation}};
    return pair;
  };
  EXPECT_EQ(
      refusal(moved({-120, 0, 0})),
      "the cameras stand 120 m apart, which is not between 0.001 and 10 m; is the calibration "
      "in another unit than metres?");
  EXPECT_NE(refusal(moved({0, 0, 0})).find("0 m apart"), std::string::npos);
  EXPECT_EQ(refusal(moved({0.12, 0, 0})),
            "the right camera stands at (-0.12, -0, -0) m before the left one, x to the right; "
            "exchange left and right");
  EXPECT_NE(refusal(moved({0, -0.12, 0})).find("cameras that stand beside each other are needed"),
            std::string::npos);
  StereoCalibration unsized = crooked_pair();
  unsized.width = 0;
  EXPECT_EQ(refusal(unsized),
            "the size of the pictures is not said; add image_width and image_height");
  StereoCalibration turned = crooked_pair();
  turned.rectification = rectification_of(turned).value();
  turned.right_T_left->linear() = rotation_from_rpy({0.021, -0.034, 0.065});
  EXPECT_NE(refusal(turned).find("R1, R2, P1, P2 do not belong to R and T: the rotations are 2.86 "
                                 "degrees off"),
            std::string::npos)
      << refusal(turned);
}

}  // namespace
}  // namespace armature::stereo
