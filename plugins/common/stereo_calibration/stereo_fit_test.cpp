// SPDX-License-Identifier: Apache-2.0
// Two cameras that are known, and the corners of boards that they see: 1. without noise they are
// found as they are, 2. with noise as well as the fit says of itself, 3. what tells nothing is
// refused, as are pairs that contradict each other.
#include "stereo_fit.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <random>

#include "armature/robot/geometry/rotation.hpp"

namespace armature::stereo {
namespace {

using Eigen::Vector3d;

StereoCalibration true_pair() {
  StereoCalibration pair{
      .width = 640,
      .height = 480,
      .left = {.fx = 520,
               .fy = 523,
               .cx = 316,
               .cy = 236,
               .distortion = {-0.22, 0.07, 0.0012, -0.0008}},
      .right = {
          .fx = 528, .fy = 526, .cx = 325, .cy = 247, .distortion = {-0.2, 0.06, -0.001, 0.0011}}};
  pair.right_T_left.emplace(Eigen::Isometry3d::Identity());
  pair.right_T_left->linear() = rotation_from_rpy({0.02, -0.03, 0.012});
  pair.right_T_left->translation() = Vector3d{-0.118, 0.002, -0.003};
  return pair;
}

std::vector<Eigen::Vector2d> board() {
  std::vector<Eigen::Vector2d> points;
  for (int row = 0; row < 6; ++row) {
    for (int column = 0; column < 9; ++column) points.emplace_back(0.025 * column, 0.025 * row);
  }
  return points;
}

/// `count` boards half a metre away, tilted by up to `tilt`.
std::vector<BoardView> views(int count, double tilt, double noise_px, std::mt19937_64& random) {
  const StereoCalibration pair = true_pair();
  std::uniform_real_distribution<double> unit{-1, 1};
  std::normal_distribution<double> noise{0, 1};
  std::vector<BoardView> all;
  for (int i = 0; i < count; ++i) {
    const Eigen::Matrix3d turn =
        rotation_from_rpy({tilt * unit(random), tilt * unit(random), 0.5 * unit(random)});
    const Vector3d middle{0.06 + 0.06 * unit(random), 0.05 * unit(random),
                          0.5 + 0.1 * unit(random)};
    BoardView view;
    for (const Eigen::Vector2d& point : board()) {
      const Vector3d left_p = middle + turn * Vector3d{point.x() - 0.1, point.y() - 0.0625, 0};
      const Vector3d right_p = *pair.right_T_left * left_p;
      const auto seen = [&](const Lens& lens, const Vector3d& p) -> Eigen::Vector2d {
        return lens.project(p.hnormalized()) +
               noise_px * Eigen::Vector2d{noise(random), noise(random)};
      };
      view.left.push_back(seen(pair.left, left_p));
      view.right.push_back(seen(pair.right, right_p));
    }
    all.push_back(std::move(view));
  }
  return all;
}

const FitOptions kOptions{.width = 640, .height = 480};

TEST(StereoFit, FindsCamerasAsTheyAreWhereCornersAreExact) {
  std::mt19937_64 random{3};
  const StereoCalibration truth = true_pair();
  for (const bool with_k3 : {false, true}) {
    FitOptions options = kOptions;
    options.with_k3 = with_k3;
    const auto fit = fit_stereo(board(), views(12, 0.6, 0, random), options);
    ASSERT_TRUE(fit) << fit.error().text;
    EXPECT_LT(fit->left_rms_px, 1e-5);
    EXPECT_LT(fit->right_rms_px, 1e-5);
    for (const auto& [found, expected] : {std::pair{&fit->calibration.left, &truth.left},
                                          {&fit->calibration.right, &truth.right}}) {
      EXPECT_NEAR(found->fx, expected->fx, 1e-3);
      EXPECT_NEAR(found->fy, expected->fy, 1e-3);
      EXPECT_NEAR(found->cx, expected->cx, 1e-3);
      EXPECT_NEAR(found->cy, expected->cy, 1e-3);
      for (std::size_t i = 0; i < 5; ++i)
        EXPECT_NEAR(found->distortion[i], expected->distortion[i], 1e-3) << i;
    }
    EXPECT_TRUE(fit->calibration.right_T_left->isApprox(*truth.right_T_left, 1e-6));
  }
}

TEST(StereoFit, KnowsHowFarOffItIs) {
  constexpr std::uint64_t kSeed = 8;
  SCOPED_TRACE("seed " + std::to_string(kSeed));
  std::mt19937_64 random{kSeed};
  const StereoCalibration truth = true_pair();
  double focal = 0, baseline = 0;  // errors, each as a part of its own sigma, squared
  constexpr int kFits = 12;
  for (int i = 0; i < kFits; ++i) {
    const auto fit = fit_stereo(board(), views(15, 0.6, 0.1, random), kOptions);
    ASSERT_TRUE(fit) << fit.error().text;
    EXPECT_NEAR(fit->left_rms_px, 0.1 * std::sqrt(2), 0.015);
    EXPECT_NEAR(fit->right_rms_px, 0.1 * std::sqrt(2), 0.015);
    EXPECT_LT(fit->errors.focal_px, 2);
    EXPECT_LT(fit->errors.baseline_m, 0.0005);
    focal += std::pow((fit->calibration.left.fx - truth.left.fx) / fit->errors.focal_px, 2) / kFits;
    const double b = fit->calibration.right_T_left->translation().norm();
    baseline +=
        std::pow((b - truth.right_T_left->translation().norm()) / fit->errors.baseline_m, 2) /
        kFits;
  }
  // A mean of twelve squares of sigma 1 is between 0.3 and 2.2 in 99 of 100 cases; the focal
  // length's sigma is the greatest of four.
  EXPECT_LT(focal, 2.2);
  EXPECT_LT(baseline, 2.2);
  EXPECT_GT(baseline, 0.25);
}

TEST(StereoFit, RefusesBoardsThatTellNothing) {
  std::mt19937_64 random{1};
  EXPECT_EQ(fit_stereo(board(), views(2, 0.6, 0, random), kOptions).error().text,
            "2 pairs show the board to both cameras; 3 are the least, 15 or more are good");
  const auto parallel = fit_stereo(board(), views(10, 0, 0.1, random), kOptions);
  ASSERT_FALSE(parallel);
  EXPECT_NE(parallel.error().text.find("tilt the board by 20 to 40 degrees to all sides"),
            std::string::npos)
      << parallel.error().text;
}

TEST(StereoFit, NamesWhatContradictsTheOtherPairs) {
  std::mt19937_64 random{5};
  auto seen = views(9, 0.6, 0.1, random);
  for (std::size_t v = 0; v < seen.size(); ++v) seen[v].name = std::to_string(v) + ".png";
  auto exchanged = seen;
  std::swap(exchanged[4].left, exchanged[4].right);
  std::swap(exchanged[7].left, exchanged[7].right);
  EXPECT_THAT(fit_stereo(board(), exchanged, kOptions).error().text,
              testing::ContainsRegex("the boards of 4.png, 7.png are up to .* px from where they "
                                     "are seen: .* leave them out$"));
  for (std::size_t v = 0; v + 1 < seen.size(); ++v) seen[v].right = seen[v + 1].right;
  EXPECT_THAT(fit_stereo(board(), seen, kOptions).error().text,
              testing::ContainsRegex("the pairs contradict each other on where the right camera "
                                     "is, by up to .* px in [5-9] of 9 pairs"));
}

TEST(StereoFit, CamerasThatWereMovedBetweenThePairsLeaveMoreTogetherThanAlone) {
  std::mt19937_64 random{6};
  auto seen = views(14, 0.6, 0.1, random);
  const auto together = [&] {
    const auto fit = fit_stereo(board(), seen, kOptions);
    EXPECT_TRUE(fit) << fit.error().text;
    EXPECT_NEAR(fit->alone_rms_px, 0.1 * std::sqrt(2), 0.015);
    return std::hypot(fit->left_rms_px, fit->right_rms_px) / std::sqrt(2);
  };
  EXPECT_NEAR(together(), 0.1 * std::sqrt(2), 0.015);
  const Lens lens = true_pair().right;
  const Eigen::Matrix3d knock = rotation_from_rpy({0, 0.0087, 0});
  for (std::size_t v = 7; v < seen.size(); ++v) {
    for (Eigen::Vector2d& pixel : seen[v].right) {
      pixel = lens.project((knock * lens.ray_of(pixel)->homogeneous()).hnormalized());
    }
  }
  EXPECT_GT(together(), 0.4) << "half a degree";
}

}  // namespace
}  // namespace armature::stereo
