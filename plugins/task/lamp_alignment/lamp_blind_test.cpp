// SPDX-License-Identifier: Apache-2.0
// A lamp that is blind stays where it is and says why: 1. no pictures come, 2. those that come
// cannot be used.
#include "lamp_room_test.hpp"

namespace armature::task::lamp_alignment {
namespace {

TEST_F(LampAlignmentTest, StaysWhereItIsWhenNoPicturesComeAndSaysSo) {
  ASSERT_TRUE(run_until(Phase::holding, 15));
  has_cameras_ = false;
  const std::size_t goals = goals_.size();
  run(60);
  EXPECT_EQ(task_.phase(), Phase::holding);
  EXPECT_EQ(goals_.size(), goals) << "a camera without a cable is no patient who has gone";
  EXPECT_EQ(task_.trouble(), "no picture has come for 2 s");
  has_cameras_ = true;
  run(0.5);
  EXPECT_EQ(task_.trouble(), "");
  EXPECT_EQ(task_.phase(), Phase::holding);
}

TEST_F(LampAlignmentTest, SaysInTheSearchAndAtTheLightThatNoPicturesCome) {
  has_cameras_ = false;
  run(3);
  EXPECT_EQ(task_.phase(), Phase::checking_light);
  EXPECT_EQ(task_.trouble(), "no picture has come for 2 s");
  has_cameras_ = true;
  ASSERT_TRUE(run_until(Phase::searching, 1));
  has_cameras_ = false;
  run(5);
  EXPECT_EQ(task_.phase(), Phase::searching);
  EXPECT_EQ(task_.trouble(), "no picture has come for 2 s");
  has_cameras_ = true;
  EXPECT_TRUE(run_until(Phase::holding, 15));
  EXPECT_EQ(task_.trouble(), "");
}

TEST_F(LampAlignmentTest, StaysWhereItIsWhileNoPictureCanBeUsedAndSaysWhy) {
  ASSERT_TRUE(run_until(Phase::holding, 15));
  unusable_ = "the right camera is frozen";
  present_ = false;
  const std::size_t goals = goals_.size();
  run(60);
  EXPECT_EQ(task_.phase(), Phase::holding);
  EXPECT_EQ(goals_.size(), goals) << "a frozen camera is no patient who has gone";
  EXPECT_EQ(task_.trouble(), "no picture could be used for 2 s: the right camera is frozen");
  unusable_.clear();
  run(1.5);
  EXPECT_EQ(task_.phase(), Phase::holding);
  EXPECT_TRUE(run_until(Phase::searching, 1)) << "now it is seen that he has gone";
}

TEST_F(LampAlignmentTest, InASearchItStaysInItsViewWhileNoPictureCanBeUsed) {
  unusable_ = "no camera_info yet";
  ASSERT_TRUE(run_until(Phase::searching, 1));
  run(10);
  EXPECT_EQ(task_.view(), 1u);
  EXPECT_EQ(goals_.size(), 1u);
  EXPECT_EQ(task_.trouble(), "no picture could be used for 2 s: no camera_info yet");
  unusable_.clear();
  EXPECT_TRUE(run_until(Phase::holding, 15));
  EXPECT_EQ(task_.trouble(), "");
}

}  // namespace
}  // namespace armature::task::lamp_alignment
