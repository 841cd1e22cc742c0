// SPDX-License-Identifier: Apache-2.0
// The alignment of grey values: 1. a disparity, a gain and rows that are known come out, 2. so does
// the uncertainty that noise causes, 3. what does not fit has no part, 4. nothing is made of
// nothing.
#include "alignment.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "armature/kinds/face_picture.hpp"

namespace armature::face_pose::surface {
namespace {

constexpr int kWidth = 200, kHeight = 120;

/// A smooth texture, defined everywhere.
double texture(double u, double v) {
  return 128 + 40 * std::sin(u / 4.1 + 0.7 * std::sin(v / 9)) + 30 * std::cos(v / 5.3 - u / 11);
}

struct Truth {
  DisparitySurface surface;
  double gain = 1, offset = 0;  // left = gain right + offset
  double row = 0;
};

/// The left picture, of which the right one follows from the truth.
Picture left_of(const Truth& truth, double noise, std::uint64_t seed) {
  Picture picture = Picture::of_one_grey(0, kWidth, kHeight);
  std::mt19937_64 random{seed};
  std::normal_distribution<double> of_pixel{0, noise};
  for (int v = 0; v < kHeight; ++v) {
    for (int u = 0; u < kWidth; ++u) {
      const double in_right = texture(u - truth.surface.at({u, v}), v + truth.row);
      picture.pixels[static_cast<std::size_t>(v * kWidth + u)] = static_cast<std::uint8_t>(
          truth.gain * in_right + truth.offset + (noise > 0 ? of_pixel(random) : 0) + 0.5);
    }
  }
  return picture;
}

Picture right() { return left_of({.surface = {}, .gain = 1, .offset = 0, .row = 0}, 0, 0); }

struct Compared {
  ComparedPixels pixels;
  GreyLevel right;
};

Compared compared(const Picture& left, const Picture& right_picture) {
  Compared result;
  GreyLevel in_left;
  const PixelBox whole{0, 0, kWidth, kHeight};
  in_left.cut(left.view(), whole, 1);
  result.right.cut(right_picture.view(), whole, 1);
  result.pixels.stride = 2;
  for (int v = 20; v < 100; v += result.pixels.stride) {
    for (int u = 60; u < 160; u += result.pixels.stride) {
      const Eigen::Vector2f at{static_cast<float>(u), static_cast<float>(v)};
      result.pixels.at.push_back(at);
      result.pixels.value.push_back(in_left.value(at.x(), at.y()));
    }
  }
  return result;
}

DisparitySurface surface(double at_middle, double by_x, double by_y, double by_x2 = 0) {
  DisparitySurface made{.middle = {110, 60}, .reach = 40};
  made.c << at_middle, by_x, by_y, by_x2, 0, 0;
  return made;
}

TEST(Alignment, FindsSurfaceGainAndRowsOfTwoPicturesThatDifferByThem) {
  const Truth truth{
      .surface = surface(20.3, 1.2, -0.8, 0.9), .gain = 0.7, .offset = 12, .row = 0.4};
  const Compared c = compared(left_of(truth, 0, 1), right());
  Alignment found{.surface = surface(20, 1, -1)};
  ASSERT_TRUE(Aligner{}.align(c.pixels, c.right,
                              {.terms = DisparitySurface::kQuadric, .rows = true}, 0, found));
  EXPECT_LT((found.surface.c - truth.surface.c).cwiseAbs().maxCoeff(), 0.02)
      << found.surface.c.transpose();
  EXPECT_NEAR(found.gain, 0.7, 0.01);
  EXPECT_NEAR(found.offset, 12, 1.5);
  EXPECT_NEAR(found.rows[0], 0.4, 0.02);
  EXPECT_NEAR(found.rows[1], 0, 0.02);
  EXPECT_GT(found.agreeing, 0.99);
}

TEST(Alignment, StatesTheUncertaintyThatNoiseCauses) {
  const Truth truth{.surface = surface(20.3, 1.2, -0.8)};
  constexpr int kRuns = 60;
  Eigen::Vector3d squares = Eigen::Vector3d::Zero(), stated = Eigen::Vector3d::Zero();
  for (int run = 0; run < kRuns; ++run) {
    const Compared c = compared(left_of(truth, 6, 100 + static_cast<std::uint64_t>(run)), right());
    Alignment found{.surface = truth.surface};
    ASSERT_TRUE(Aligner{}.align(c.pixels, c.right,
                                {.terms = DisparitySurface::kPlane, .rows = true}, 0, found));
    squares += (found.surface.c - truth.surface.c).head<3>().cwiseAbs2() / kRuns;
    stated += found.covariance.diagonal().head<3>() / kRuns;
  }
  for (int i = 0; i < 3; ++i) {
    const double ratio = std::sqrt(squares[i] / stated[i]);
    EXPECT_GT(ratio, 0.6) << i;
    EXPECT_LT(ratio, 1.6) << i;
  }
}

TEST(Alignment, WhatCoversAQuarterHasNoPart) {
  const Truth truth{.surface = surface(20.3, 1.2, -0.8)};
  Picture left = left_of(truth, 1, 7);
  for (int v = 0; v < kHeight; ++v) {
    for (int u = 0; u < 85; ++u) {
      left.pixels[static_cast<std::size_t>(v * kWidth + u)] =
          static_cast<std::uint8_t>(texture(u * 1.3 + 50, v * 0.8));
    }
  }
  const Compared c = compared(left, right());
  Alignment found{.surface = surface(20.5, 1, -1)};
  ASSERT_TRUE(Aligner{}.align(c.pixels, c.right, {.terms = DisparitySurface::kPlane, .rows = true},
                              0, found));
  EXPECT_LT((found.surface.c - truth.surface.c).cwiseAbs().maxCoeff(), 0.05)
      << found.surface.c.transpose();
  EXPECT_LT(found.agreeing, 0.85);
  EXPECT_GT(found.agreeing, 0.6);
}

TEST(Alignment, SaysNoWhereNothingTellsWhereItBelongs) {
  const auto is_aligned = [](const Picture& left, const Picture& right_picture) {
    const Compared c = compared(left, right_picture);
    Alignment found{.surface = surface(20, 0, 0)};
    return Aligner{}.align(c.pixels, c.right, {.terms = DisparitySurface::kPlane, .rows = true}, 0,
                           found);
  };
  const Picture grey = Picture::of_one_grey(100, kWidth, kHeight);
  EXPECT_FALSE(is_aligned(grey, grey));
  const Picture white = Picture::of_one_grey(255, kWidth, kHeight);
  EXPECT_FALSE(is_aligned(right(), white));
  EXPECT_TRUE(is_aligned(left_of({.surface = surface(20.4, 0, 0)}, 0, 1), right()));
}

}  // namespace
}  // namespace armature::face_pose::surface
