// SPDX-License-Identifier: Apache-2.0
#include "armature/robot/orientations/corner_blend.hpp"

#include <gtest/gtest.h>

#include <random>

namespace armature {
namespace {

class CornerBlend : public ::testing::Test {
 protected:
  Eigen::Vector3d any() { return {normal_(random_), normal_(random_), normal_(random_)}; }
  double positive() { return std::uniform_real_distribution<double>{0.05, 2}(random_); }

  const ::testing::ScopedTrace seed_{__FILE__, __LINE__, "seed 32"};
  std::mt19937_64 random_{32};
  std::normal_distribution<double> normal_;
};

TEST_F(CornerBlend, RunsFromDThroughBToEAndBendsAtNeitherEnd) {
  for (int i = 0; i < 1000; ++i) {
    const Eigen::Vector3d D = any(), B = any(), E = any(), at_D = any(), at_E = any();
    const double duration = positive(), h = duration / 4;
    const auto pieces = cubics_of(corner_controls(D, B, E, at_D, at_E), duration);
    EXPECT_LE((pieces[0].value(0) - D).norm(), 1e-13);
    EXPECT_LE((pieces[1].value(h) - B).norm(), 1e-13);
    EXPECT_LE((pieces[2].value(0) - B).norm(), 1e-13);
    EXPECT_LE((pieces[3].value(h) - E).norm(), 1e-13);
    EXPECT_LE((duration * pieces[0].first(0) - at_D).norm(), 1e-12);
    EXPECT_LE((duration * pieces[3].first(h) - at_E).norm(), 1e-12);
    EXPECT_LE(duration * duration * pieces[0].second(0).norm(), 1e-11);
    EXPECT_LE(duration * duration * pieces[3].second(h).norm(), 1e-11);
  }
}

TEST_F(CornerBlend, HasNoStepInPlaceVelocityOrAccelerationAtItsInnerKnots) {
  for (int i = 0; i < 1000; ++i) {
    const auto pieces = cubics_of(corner_controls(any(), any(), any(), any(), any()), 4);
    for (std::size_t k = 1; k < pieces.size(); ++k) {
      const VectorCubic &before = pieces[k - 1], &behind = pieces[k];
      EXPECT_LE((before.value(1) - behind.value(0)).norm(), 1e-13);
      EXPECT_LE((before.first(1) - behind.first(0)).norm(), 1e-12);
      EXPECT_LE((before.second(1) - behind.second(0)).norm(), 1e-12);
    }
  }
}

/// Keys at uneven parameters: any number of pieces, any velocity of each line.
TEST_F(CornerBlend, LinesThroughAnyPointsAtAnyParametersMeetTheirBlendsWithoutAStep) {
  for (int i = 0; i < 200; ++i) {
    std::vector<Eigen::Vector3d> points{any()}, slopes;
    std::vector<double> u{0};
    for (int k = 0; k < 8; ++k) {
      u.push_back(u.back() + positive());
      points.push_back(any());
      slopes.push_back((points[points.size() - 1] - points[points.size() - 2]) /
                       (u[u.size() - 1] - u[u.size() - 2]));
    }
    const auto pieces = blend_pieces(points, slopes, u);
    for (std::size_t k = 1; k < pieces.size(); ++k) {
      const double length = pieces[k].start - pieces[k - 1].start;
      ASSERT_GT(length, 0);
      const VectorCubic &before = pieces[k - 1].cubic, &behind = pieces[k].cubic;
      EXPECT_LE((before.value(length) - behind.value(0)).norm(), 1e-12);
      EXPECT_LE((before.first(length) - behind.first(0)).norm(), 1e-10);
      EXPECT_LE((before.second(length) - behind.second(0)).norm(), 1e-8);
    }
    const BlendedPolyline line{points, u};
    for (std::size_t k = 0; k < u.size(); ++k) EXPECT_LE((line.at(u[k]) - points[k]).norm(), 1e-12);
    EXPECT_EQ(line.at(-1), line.at(0));
    EXPECT_EQ(line.at(u.back() + 1), line.at(u.back()));
  }
}

TEST_F(CornerBlend, EvenKeysHaveNoLinesBetweenTheirBlends) {
  const std::vector<Eigen::Vector3d> points{any(), any(), any(), any()};
  const std::vector<Eigen::Vector3d> slopes{points[1] - points[0], points[2] - points[1],
                                            points[3] - points[2]};
  const auto pieces = blend_pieces(points, slopes, std::vector<double>{0, 1, 2, 3});
  ASSERT_EQ(pieces.size(), 10u);  // half a line, two corners of four, half a line
  EXPECT_EQ(pieces[4].key, 1u);
  EXPECT_EQ(pieces[5].key, 2u);
}

}  // namespace
}  // namespace armature
