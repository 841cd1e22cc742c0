// SPDX-License-Identifier: Apache-2.0
// A shaft in an incision. 1. Where it lies to the point. 2. What pivoting keeps and what it
// changes.
#include "armature/robot/kinematics/remote_centre.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

namespace armature {
namespace {

using Eigen::Isometry3d;
using Eigen::Vector3d;

class RemoteCentreTest : public ::testing::Test {
 protected:
  void SetUp() override { RecordProperty("seed", kSeed); }

  Vector3d any_vector() { return {number_(random_), number_(random_), number_(random_)}; }
  Isometry3d any_pose() {
    const Eigen::AngleAxisd turn{M_PI * number_(random_), any_vector().normalized()};
    return Eigen::Translation3d{any_vector()} * turn;
  }
  RemoteCentre any_centre() {
    return {.point = any_vector(), .shaft = {.axis = any_vector().normalized(), .length = 0.3}};
  }

  static constexpr int kSeed = 4;
  std::mt19937_64 random_{kSeed};
  std::uniform_real_distribution<double> number_{-1, 1};
};

TEST_F(RemoteCentreTest, APointOnTheShaftIsItsDepthBehindTheTip) {
  for (int i = 0; i < 10000; ++i) {
    const Isometry3d pose = any_pose();
    RemoteCentre centre = any_centre();
    const double depth = number_(random_), aside = std::abs(number_(random_));
    const Vector3d axis = pose.linear() * centre.shaft.axis;
    centre.point = pose.translation() - depth * axis + aside * axis.unitOrthogonal();
    ASSERT_NEAR(centre.depth(pose), depth, 1e-12) << "seed " << kSeed << ", case " << i;
    ASSERT_NEAR(centre.deviation(pose), aside, 1e-12) << "seed " << kSeed << ", case " << i;
  }
}

TEST_F(RemoteCentreTest, APivotedShaftRunsThroughThePointWithItsTipWhereItWas) {
  for (int i = 0; i < 10000; ++i) {
    const RemoteCentre centre = any_centre();
    const Isometry3d pose = any_pose(), pivoted = centre.pivoted(pose);
    SCOPED_TRACE(::testing::Message() << "seed " << kSeed << ", case " << i);
    ASSERT_LT((pivoted.translation() - pose.translation()).norm(), 1e-15);
    ASSERT_LT(centre.deviation(pivoted), 1e-12);
    ASSERT_NEAR(centre.depth(pivoted), (pose.translation() - centre.point).norm(), 1e-12);
    const Eigen::AngleAxisd turn{pivoted.linear() * pose.linear().transpose()};
    if (turn.angle() < 1e-6 || turn.angle() > M_PI - 1e-6) continue;
    ASSERT_NEAR(turn.axis().dot(pose.linear() * centre.shaft.axis), 0, 1e-8)
        << "it does not roll about the shaft";
  }
}

TEST_F(RemoteCentreTest, AShaftThatRunsThroughThePointStaysAsItIs) {
  for (int i = 0; i < 1000; ++i) {
    RemoteCentre centre = any_centre();
    const Isometry3d pose = any_pose();
    centre.point = pose * Vector3d{-0.1 * centre.shaft.axis};
    ASSERT_TRUE(centre.pivoted(pose).isApprox(pose, 1e-12)) << "seed " << kSeed << ", case " << i;
  }
}

}  // namespace
}  // namespace armature
