// SPDX-License-Identifier: Apache-2.0
// A tracker, or its driver, that tells what it told before: 1. with new stamps while the drill is
// in the bone, 2. with new stamps while the jaw is located, 3. with the same stamps.
#include <gtest/gtest.h>

#include "implant_room_test.hpp"

namespace armature::task::implant {
namespace {

class FrozenTest : public ImplantTest {
 protected:
  FrozenTest() {
    jitter_m_ = 2e-5;
    Parameters parameters = quick(true);
    parameters.samples_per_pose = 10;
    parameters.jaw_samples = 60;
    parameters.dwell = 3;
    task_ = Implant{parameters, med7(), file_tool_};
    begin();
  }
  /// From now on the jaw goes where nobody sees it.
  void freeze() {
    frozen_ = true;
    chain_.tracker_T_patient.translation().x() += 0.02;
  }
};

TEST_F(FrozenTest, WhileItDrillsItStopsAtTheSiteWhereItIs) {
  go_to(Phase::drilling);
  step();
  const std::size_t until_then = goals_.size();
  freeze();
  wait(0.5);
  EXPECT_EQ(task_.phase(), Phase::drilling) << "as long as a silent one";
  wait(0.06);
  EXPECT_EQ(task_.phase(), Phase::refused);
  EXPECT_EQ(task_.trouble().substr(0, 38), "the tracker has not seen the jaw for 0");
  EXPECT_EQ(task_.trouble().substr(45), "it gives the same pose again and again");
  EXPECT_EQ(goals_.size(), until_then);
}

TEST_F(FrozenTest, WhileTheJawIsLocatedNothingSetsOut) {
  go_to(Phase::locating);
  const std::size_t until_then = goals_.size();
  freeze();
  go_to(Phase::refused);
  EXPECT_EQ(task_.trouble().substr(45), "it gives the same pose again and again");
  EXPECT_EQ(goals_.size(), until_then) << "only the calibration's";
}

TEST_F(FrozenTest, ASampleOfTheJawThatIsToldManyTimesIsAveragedOnce) {
  times_ = 20;
  go_to(Phase::locating);
  int samples = 0;
  for (; samples < 500 && task_.phase() == Phase::locating; ++samples) step();
  EXPECT_EQ(task_.phase(), Phase::approaching) << task_.trouble();
  EXPECT_GE(samples, 60) << "'jaw_samples'";
}

}  // namespace
}  // namespace armature::task::implant
