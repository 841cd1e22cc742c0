// SPDX-License-Identifier: Apache-2.0
// Whether markers tell a mirrored image: 1. a body of markers does, 2. a plane or three do not,
// 3. markers that were only compared count, and those that moved do not, 4. nor do those in any
// order that are their own mirror image.
#include "armature/kinds/registration/handedness.hpp"

#include <gtest/gtest.h>

#include <vector>

#include "armature/kinds/registration/marker_matching.hpp"
#include "armature/kinds/registration/moved_head.hpp"
#include "armature/kinds/registration/rigid_fit.hpp"

namespace armature {
namespace {

class Handedness : public testing::Test, public MovedHead {
 protected:
  static constexpr double kError = 0.0005;  // [m]

  /// The best motion of those that are used.
  static Registration fitted(const MarkerPairs& markers, std::vector<bool> used) {
    Registration found;
    found.used = std::move(used);
    const MarkerPairs some = only(markers, found.used);
    found.robot_T_image = rigid_fit(some.image, some.robot);
    measure_residuals(markers, found);
    return found;
  }
  static Registration fitted(const MarkerPairs& markers) {
    return fitted(markers, std::vector<bool>(markers.image.size(), true));
  }
  /// In the plane z = 0 but for the last one, which lies `height` above it.
  MarkerPairs flat_but(double height) {
    MarkerPairs markers{
        {{0.08, 0, 0}, {-0.03, 0.07, 0}, {-0.05, -0.06, 0}, {0.04, -0.05, 0}, {0.01, 0.03, height}},
        {}};
    const Eigen::Isometry3d motion = random_motion();
    for (const Eigen::Vector3d& marker : markers.image) markers.robot.push_back(motion * marker);
    return with_noise(markers, kError);
  }
};

TEST_F(Handedness, IsToldByMarkersThatSpanABody) {
  SCOPED_TRACE(kSeed);
  for (int i = 0; i < 200; ++i) {
    const MarkerPairs head = with_noise(seen(random_motion()), kError);
    EXPECT_EQ(unchecked_handedness(head, fitted(head), kError), std::nullopt) << i;
    const MarkerPairs high = flat_but(0.03);
    EXPECT_EQ(unchecked_handedness(high, fitted(high), kError), std::nullopt) << i;
  }
}

TEST_F(Handedness, IsNotToldByThreeMarkersNorByAPlane) {
  SCOPED_TRACE(kSeed);
  for (int i = 0; i < 200; ++i) {
    const MarkerPairs flat = flat_but(0);
    EXPECT_TRUE(unchecked_handedness(flat, fitted(flat), kError)) << i;
    const MarkerPairs head = with_noise(seen(random_motion()), kError);
    const MarkerPairs three = only(head, {true, true, true, false, false, false});
    EXPECT_TRUE(unchecked_handedness(three, fitted(three), kError)) << i;
  }
  const MarkerPairs high = flat_but(0.03);
  EXPECT_TRUE(unchecked_handedness(high, fitted(high), 0.03)) << "not with so large an error";
}

TEST_F(Handedness, IsToldByMarkersThatWereOnlyComparedButByNoneThatMoved) {
  const std::vector<bool> three{true, true, true, false, false, false};
  MarkerPairs head = seen(random_motion());
  EXPECT_EQ(unchecked_handedness(head, fitted(head, three), kError), std::nullopt);
  for (std::size_t i = 3; i < 6; ++i) head.robot[i] += Eigen::Vector3d{0.01, 0.02, 0};
  EXPECT_TRUE(unchecked_handedness(head, fitted(head, three), kError));
}

TEST_F(Handedness, IsNotToldByMarkersInAnyOrderThatLieAlikeOnBothSidesOfAPlane) {
  const std::vector<Eigen::Vector3d> alike{{0.08, 0.03, 0.03},
                                           {-0.08, 0.03, 0.03},
                                           {0.055, -0.06, 0.04},
                                           {-0.055, -0.06, 0.04},
                                           {0, -0.02, 0.088}};
  const auto told = [&](const std::vector<Eigen::Vector3d>& image, double side) {
    std::vector<Eigen::Vector3d> robot;
    for (const Eigen::Vector3d& marker : image) {
      robot.push_back({1 + side * marker.x(), 2 + marker.z(), 3 - marker.y()});
    }
    return !exchangeable_handedness(match_markers(image, robot, 0.003).value(), kError);
  };
  EXPECT_FALSE(told(alike, 1));
  EXPECT_FALSE(told(alike, -1)) << "which is the same points";
  std::vector<Eigen::Vector3d> other = alike;
  other[2].y() += 0.02;
  EXPECT_TRUE(told(other, 1));
  EXPECT_TRUE(told(head(), 1));
}

TEST_F(Handedness, ThatIsNotToldIsRefusedWithFiguresAndTheWayOut) {
  MarkerPairs flat{{{0.08, 0, 0}, {-0.03, 0.07, 0}, {-0.05, -0.06, 0}}, {}};
  flat.robot = flat.image;
  flat.robot[0].x() += 0.003;
  EXPECT_EQ(
      exchangeable_handedness({std::vector<std::size_t>(5), 0.0004}, 0.0005).value_or(""),
      "the markers do not tell whether the images are mirrored: exchanged, they fit their "
      "mirror image to 0.4 mm, and an error of 0.5 mm a marker explains 0.88 mm. Put a marker "
      "where none is on the other side, or vouch for the images (handedness_vouched: true)");
  EXPECT_EQ(
      unchecked_handedness(flat, fitted(flat), 0.001).value_or(""),
      "the markers do not tell whether the images are mirrored: they fit to 1.4 mm, and their "
      "mirror image to 1.4 mm, of which an error of 1 mm a marker explains 1.9 mm. Put a "
      "marker out of the plane of the others, or vouch for the images (handedness_vouched: "
      "true)");
}

}  // namespace
}  // namespace armature
