// SPDX-License-Identifier: Apache-2.0
// Zhong et al.: T_R_N from hand-eye calibration, with a marker body on the flange. The recorded
// poses of tests/data/dental_implant_reference.yaml.
#include <gtest/gtest.h>

#include <vector>

#include "armature/calibration/hand_eye.hpp"
#include "armature/robot/kinematics/kinematics.hpp"
#include "reference_file.hpp"

namespace armature::paper {
namespace {

class DentalImplantCalibration : public testing::Test {
 protected:
  std::vector<HandEyePose> poses() const {
    std::vector<HandEyePose> result;
    for (std::size_t i = 0; i < figures_["poses"].size(); ++i) {
      const Figures pose = figures_["poses"][i];
      result.push_back({pose["T_R_F"].transform(), pose["T_N_T"].transform()});
    }
    return result;
  }
  static double difference(const Eigen::Isometry3d& found, const Figures& wanted) {
    return (found.matrix() - wanted.transform().matrix()).cwiseAbs().maxCoeff();
  }

  const Figures figures_ = dental_implant()["hand_eye"];
};

TEST_F(DentalImplantCalibration, FindsTrackerAndMarkerBodyFromTheRecordedPoses) {
  const auto found = calibrate_hand_eye(poses());
  ASSERT_TRUE(found) << found.error().text;
  constexpr double kPrinted = 5e-12;  // the figures have 12 digits
  EXPECT_LE(difference(found->flange_T_body, figures_["X_flange_to_marker_body"]), kPrinted);
  EXPECT_LE(difference(found->base_T_tracker, figures_["Z_robot_from_tracker"]), kPrinted);
  EXPECT_LE(found->residual_rms_m, kPrinted);
  EXPECT_LE(found->residual_rms_rad, kPrinted);
}

TEST_F(DentalImplantCalibration, TheRecordedJointsAreThoseOfTheFlangesPoses) {
  const RobotModel med7 = load_robot_model(ARMATURE_SOURCE_DIR "/configs/robots/med7.yaml");
  const Figures all = figures_["poses"];
  for (std::size_t i = 0; i < all.size(); ++i) {
    const JointVector q = all[i]["q"].numbers();
    EXPECT_LE(difference(forward_kinematics(med7, q, *med7.find_frame("flange")), all[i]["T_R_F"]),
              1e-11)
        << i;
  }
}

}  // namespace
}  // namespace armature::paper
