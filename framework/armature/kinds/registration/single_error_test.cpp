// SPDX-License-Identifier: Apache-2.0
// What one wrong marker does to a target: 1. where the others do not check it, its whole error is
// in the bound, 2. or nothing is told, 3. where they do, the bound is little more than that of
// chance,
// 4. markers that were only compared check as well, 5. an error that is stated too small is not
// believed.
#include "armature/kinds/registration/single_error.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "armature/kinds/registration/explained_fit.hpp"
#include "armature/kinds/registration/moved_head.hpp"
#include "armature/kinds/registration/rigid_fit.hpp"

namespace armature {
namespace {

class ErrorWithOneWrong : public testing::Test, public MovedHead {
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
  /// Four, of which the second one has turned about the line that the others nearly lie on.
  static MarkerPairs turned_second(const Eigen::Vector3d& fourth, double way) {
    MarkerPairs markers{
        {{-0.0453, 0.0762, 0.0155}, {-0.0545, -0.0420, 0.0580}, {0.0037, 0.0264, 0.0859}, fourth},
        {}};
    markers.robot = markers.image;
    const Eigen::Vector3d first = markers.image[0];
    const Eigen::Vector3d line = (markers.image[2] + fourth - 2 * first).normalized();
    const Eigen::Vector3d arm = markers.image[1] - first;
    const double radius = (arm - arm.dot(line) * line).norm();
    markers.robot[1] = first + Eigen::AngleAxisd{way / radius, line} * arm;
    return markers;
  }
  double off(const Registration& found) const {
    return (found.robot_T_image * target_ - target_).norm();
  }

  const Eigen::Vector3d target_{0.010, 0.005, 0.012};
};

TEST_F(ErrorWithOneWrong, OfAMarkerThatTurnsAboutTheOthersIsInTheBound) {
  for (const double mm : {2.0, 5.0, 8.0}) {
    const MarkerPairs markers = turned_second({0.0160, 0.0100, 0.0800}, 1e-3 * mm);
    const Registration found = fitted(markers);
    EXPECT_EQ(unexplained_fit(markers, found, kError), std::nullopt) << "as good as any, " << mm;
    const auto error = error_with_one_wrong(markers, found, target_, kError);
    ASSERT_TRUE(error) << error.error().text;
    EXPECT_GT(error->bound95_m, off(found)) << mm;
    EXPECT_GT(off(found), 0.0004 * mm) << mm;
  }
}

TEST_F(ErrorWithOneWrong, IsNotToldWhereNothingChecksAMarker) {
  const MarkerPairs markers = turned_second({0.0086, 0.0214, 0.0929}, 0.0177);
  const Registration found = fitted(markers);
  EXPECT_EQ(unexplained_fit(markers, found, kError), std::nullopt);
  EXPECT_GT(off(found), 0.01);
  const auto error = error_with_one_wrong(markers, found, target_, kError);
  ASSERT_FALSE(error);
  EXPECT_EQ(error.error().text,
            "nothing checks marker 2: without it the others lie nearly on one line");
  const MarkerPairs three = only(seen_anywhere(), {true, true, true, false, false, false});
  EXPECT_EQ(error_with_one_wrong(three, fitted(three), target_, kError).error().text,
            "3 markers agree, and none of them is checked: four are needed");
}

TEST_F(ErrorWithOneWrong, IsLittleMoreThanThatOfChanceWhereTheMarkersCheckEachOther) {
  SCOPED_TRACE(kSeed);
  constexpr double kOfSix = 0.00037;  // [m] what six markers of half a millimetre are predicted
  for (int i = 0; i < 1000; ++i) {
    const MarkerPairs markers = with_noise(seen_anywhere(), kError);
    const auto error = error_with_one_wrong(markers, fitted(markers), target_, kError);
    ASSERT_TRUE(error) << i << ": " << error.error().text;
    EXPECT_GT(error->bound95_m, kOfSix) << i;
    EXPECT_LT(error->bound95_m, 3 * kOfSix) << i;
  }
}

TEST_F(ErrorWithOneWrong, MarkersThatWereOnlyComparedCheckThoseThatDecided) {
  const MarkerPairs head = seen_anywhere();
  const Registration by_three = fitted(head, {true, true, true, false, false, false});
  EXPECT_TRUE(error_with_one_wrong(head, by_three, target_, kError));
  MarkerPairs wrong = head;
  for (std::size_t i = 3; i < 6; ++i) wrong.robot[i] += gauss(0.03);
  EXPECT_EQ(error_with_one_wrong(wrong, fitted(wrong, by_three.used), target_, kError).error().text,
            "3 markers agree, and none of them is checked: four are needed");
}

TEST_F(ErrorWithOneWrong, IsOfTheErrorThatTheOthersShow) {
  const MarkerPairs markers = with_noise(seen_anywhere(), 0.002);
  const Registration found = fitted(markers);
  const double as_stated = error_with_one_wrong(markers, found, target_, 0.002)->bound95_m;
  EXPECT_GT(error_with_one_wrong(markers, found, target_, 0.0001)->bound95_m, 0.5 * as_stated);
}

}  // namespace
}  // namespace armature
