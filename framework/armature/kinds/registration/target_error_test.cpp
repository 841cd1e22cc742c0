// SPDX-License-Identifier: Apache-2.0
// The sphere that holds 95 % of a normal distribution.
#include "armature/kinds/registration/target_error.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace armature {
namespace {

/// Of chi-squared with 1, 2 and 3 degrees of freedom: the value that 95 % are below.
constexpr double kQuantile[]{3.841458820694124, 5.991464547107979, 7.814727903251179};

TEST(RadiusOf95Percent, IsThatOfTheChiSquaredDistributions) {
  Eigen::Vector3d variances = Eigen::Vector3d::Zero();
  constexpr double kTooSmall[]{0.013, 0.006, 0.003};
  for (int freedom = 1; freedom <= 3; ++freedom) {
    variances[freedom - 1] = 4e-6;
    const double exact = 0.002 * std::sqrt(kQuantile[freedom - 1]);
    const double radius = radius_of_95_percent(variances.asDiagonal());
    EXPECT_LE(radius, exact);
    EXPECT_GE(radius, exact * (1 - kTooSmall[freedom - 1])) << freedom;
  }
}

TEST(RadiusOf95Percent, IsZeroWithoutError) {
  EXPECT_EQ(radius_of_95_percent(Eigen::Matrix3d::Zero()), 0);
}

/// Takes the first marker for the origin.
class FirstMarker final : public Registrar {
 public:
  Expected<Registration> find(const MarkerPairs& markers) const override {
    if (markers.robot.front().norm() > 10) return refuse("too far away");
    Registration found;
    found.robot_T_image.translation() = markers.robot.front() - markers.image.front();
    return found;
  }
};

TEST(PredictedError, IsThatOfTheMarkersAsTheMethodPassesItOn) {
  const MarkerPairs markers{{{0, 0, 0}, {1, 0, 0}}, {{1, 2, 3}, {2, 2, 3}}};
  const auto error = predicted_error(FirstMarker{}, markers, {5, 5, 5}, 0.003);
  ASSERT_TRUE(error);
  EXPECT_NEAR(error->rms_m, 0.003, 1e-12);
  EXPECT_LT((error->covariance - 3e-6 * Eigen::Matrix3d::Identity()).norm(), 1e-14);
}

TEST(PredictedError, RefusesWhatTheMethodRefusesAndWhatIsNoNumber) {
  const MarkerPairs good{{{0, 0, 0}}, {{1, 2, 3}}}, far_away{{{0, 0, 0}}, {{11, 0, 0}}};
  EXPECT_EQ(predicted_error(FirstMarker{}, far_away, {0, 0, 0}, 0.001).error().text,
            "too far away");
  EXPECT_EQ(predicted_error(FirstMarker{}, good, {0, NAN, 0}, 0.001).error().text,
            "the target is not finite");
  EXPECT_EQ(predicted_error(FirstMarker{}, good, {0, 0, 0}, -1).error().text,
            "a marker's error is -1 m");
}

}  // namespace
}  // namespace armature
