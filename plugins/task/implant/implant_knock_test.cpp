// SPDX-License-Identifier: Apache-2.0
// A tracker that is knocked, or a body that slips on the flange, after the hand-eye calibration:
// 1. before the approach nothing sets out, 2. above a site the arm stops, 3. what only errs as a
// tracker does is no knock.
#include <gtest/gtest.h>

#include "implant_room_test.hpp"

namespace armature::task::implant {
namespace {

class KnockTest : public ImplantTest {
 protected:
  /// The tracker moves in the base frame; arm and jaw stay where they are.
  void knock(const Isometry3d& motion) {
    const Isometry3d base_T_jaw = chain_.base_T_tracker * chain_.tracker_T_patient;
    chain_.base_T_tracker = motion * chain_.base_T_tracker;
    chain_.tracker_T_patient = chain_.base_T_tracker.inverse() * base_T_jaw;
  }
  Vector3d body() const { return base_T_flange_ * chain_.flange_T_body.translation(); }
  Isometry3d turn_about(const Vector3d& point, double angle) const {
    return Eigen::Translation3d{point} * Eigen::AngleAxisd{angle, Vector3d{1, -1, 1}.normalized()} *
           Eigen::Translation3d{-point};
  }
  /// Registered, with the arm as it was calibrated.
  void calibrate() {
    begin();
    go_to(Phase::registering);
  }
  void expect_refused(const std::string& off) {
    go_to(Phase::refused);
    EXPECT_EQ(task_.trouble(),
              "the tracker sees the body on the flange " + off +
                  " off where the hand-eye calibration has it, 1 mm are allowed: the tracker or "
                  "the body has moved since; calibrate again");
  }
};

TEST_F(KnockTest, ATrackerThatIsKnockedBeforeTheRegistrationIsFoundAndNothingSetsOut) {
  calibrate();
  knock(Isometry3d{Eigen::Translation3d{0.012, 0, -0.016}});
  expect_refused("20.00 mm");
  EXPECT_EQ(goals_.size(), 8u) << "only the calibration's";
}

TEST_F(KnockTest, ATrackerThatTurnsAboutTheToolIsFoundByWhatItDoesToTheBores) {
  calibrate();
  knock(turn_about(base_T_flange_ * chain_.flange_T_tool().translation(), 0.5 * M_PI / 180));
  expect_refused("1.81 mm");
  EXPECT_EQ(goals_.size(), 8u);
}

TEST_F(KnockTest, ABodyThatSlipsOnTheFlangeIsFoundAndNothingSetsOut) {
  calibrate();
  chain_.flange_T_body.translation() += Vector3d{0.003, 0.004, 0};
  expect_refused("5.00 mm");
  EXPECT_EQ(goals_.size(), 8u);
}

TEST_F(KnockTest, ABodyThatSlipsWhileTheToolRestsAtTheBottomStopsTheArm) {
  Parameters parameters = quick(true);
  parameters.dwell = 1;
  task_ = Implant{parameters, med7(), file_tool_};
  calibrate();
  go_to(Phase::drilling);
  step();
  const std::size_t until_then = goals_.size();
  chain_.flange_T_body.translation() += Vector3d{0.003, 0.004, 0};
  go_to(Phase::refused);
  EXPECT_EQ(task_.trouble().substr(0, 39), "the tracker sees the body on the flange");
  EXPECT_EQ(goals_.size(), until_then) << "it stays at the bottom";
}

TEST_F(KnockTest, ABodyThatSlipsWhileTheOperatorIsAskedIsFoundAndNothingSetsOut) {
  Parameters parameters = quick();
  parameters.auto_confirm = false;
  task_ = Implant{parameters, med7(), file_tool_};
  calibrate();
  go_to(Phase::approaching);
  const std::size_t until_then = goals_.size();
  chain_.flange_T_body.translation() += Vector3d{0.003, 0.004, 0};
  expect_refused("5.00 mm");
  EXPECT_EQ(goals_.size(), until_then);
}

TEST_F(KnockTest, AFlangeThatIsNotSeenWhileTheJawIsLocatedIsNamed) {
  calibrate();
  see_flange_ = false;
  go_to(Phase::refused);
  EXPECT_EQ(task_.trouble(), "the tracker has not seen the flange for 0.52 s: it sends nothing");
  EXPECT_EQ(goals_.size(), 8u);
}

TEST_F(KnockTest, ATrackerThatErrsIsNoKnockHoweverLongTheOperatorIsAsked) {
  for (const unsigned seed : {1u, 2u, 3u, 4u}) {
    SCOPED_TRACE(testing::Message() << "seed " << seed);
    random_.seed(seed);
    Parameters parameters = quick();
    parameters.auto_confirm = false;
    parameters.samples_per_pose = 10;
    parameters.jaw_samples = 60;
    task_ = Implant{parameters, med7(), file_tool_};
    done_ = 0;
    jitter_m_ = 1e-4;  // and 1 mrad
    calibrate();
    go_to(Phase::approaching);
    wait(100);
    EXPECT_EQ(task_.phase(), Phase::approaching) << task_.trouble();
  }
}

}  // namespace
}  // namespace armature::task::implant
