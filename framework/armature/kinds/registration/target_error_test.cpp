// SPDX-License-Identifier: Apache-2.0
// What a registration method passes on of the markers' errors.
#include "armature/kinds/registration/target_error.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace armature {
namespace {

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
