// SPDX-License-Identifier: Apache-2.0
// A lamp that is blind stays where it is and says why: 1. no pictures come, 2. those that come
// cannot be used, 3. what it has seen is old.
#include <algorithm>

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

TEST_F(LampAlignmentTest, InASearchItLeavesAViewThoughEveryOtherPictureCannotBeUsed) {
  ASSERT_TRUE(run_until(Phase::searching, 1));
  for (int k = 0; k < 1000 && task_.phase() == Phase::searching; ++k) {
    unusable_ = k / 5 % 2 == 0 ? "the left camera gives its last picture again" : "";
    tick();
  }
  EXPECT_EQ(task_.phase(), Phase::aligning);
}

class LampThatWasPausedTest : public LampAlignmentTest {
 protected:
  std::string say(const std::string& word) {
    const auto obeyed = task_.hear({.id = ++said_, .word = word, .step = ""}, now_);
    return obeyed ? "" : obeyed.error().text;
  }
  /// The cameras fail, and it goes on ten minutes later.
  void resume_blind() {
    has_cameras_ = false;
    run(600);
    ASSERT_EQ(task_.trouble(), "no picture has come for 2 s");
    const std::size_t goals = goals_.size();
    ASSERT_EQ(say("resume"), "");
    run(10);
    EXPECT_EQ(goals_.size(), goals) << "where the patient was ten minutes ago";
  }

  std::uint64_t said_ = 0;
};

TEST_F(LampThatWasPausedTest, InAViewItDoesNotSetOutForAFaceThatWasSeenInThePause) {
  present_ = false;
  while (!looks_ahead()) tick();
  EXPECT_EQ(say("pause"), "");
  present_ = true;
  run(3);
  present_ = false;
  run(60);
  resume_blind();
  EXPECT_EQ(task_.phase(), Phase::searching);
  present_ = has_cameras_ = true;
  EXPECT_TRUE(run_until(Phase::holding, 15));
}

TEST_F(LampThatWasPausedTest, HoldingItDoesNotSetOutForAPatientWhoMovedInThePause) {
  for (const double moved_m : {0.1, 0.005}) {
    ASSERT_TRUE(run_until(Phase::holding, 15));
    EXPECT_EQ(say("pause"), "");
    mouth_.y() += moved_m;
    run(4);
    resume_blind();
    has_cameras_ = true;
    const std::size_t goals = goals_.size();
    mouth_.y() -= moved_m;
    run(10);
    EXPECT_EQ(goals_.size(), goals) << "he is where he was before, and what is old counts no more";
  }
}

TEST_F(LampThatWasPausedTest, AtRestBeforeAFaceItDoesNotSetOutForWhatItSawInThePause) {
  ASSERT_TRUE(run_until(Phase::aligning, 10));
  run(1.1);
  ASSERT_EQ(task_.phase(), Phase::aligning);
  ASSERT_FALSE(goal_) << "it is there";
  EXPECT_EQ(say("pause"), "");
  velocity_ = {0, 0.05, 0};
  mouth_.y() += 0.05;
  run(3);
  resume_blind();
}

TEST_F(LampThatWasPausedTest, AWayToAFaceThatIsLostMeanwhileIsNotGoneToItsEnd) {
  ASSERT_TRUE(run_until(Phase::aligning, 10));
  tick();
  EXPECT_EQ(say("pause"), "");
  has_cameras_ = false;
  run(600);
  const std::size_t goals = goals_.size();
  EXPECT_EQ(say("resume"),
            "the face that it was on its way to has not been seen for 2 s: 'back' searches for it");
  run(5);
  EXPECT_EQ(goals_.size(), goals);
  EXPECT_EQ(say("back"), "");
  has_cameras_ = true;
  EXPECT_TRUE(run_until(Phase::holding, 15));
}

class LampWithALateMotionTest : public LampAlignmentTest {
 protected:
  /// For a second.
  void send_to_the_face() {
    ASSERT_TRUE(run_until(Phase::aligning, 10));
    run(1);
    EXPECT_EQ(task_.phase(), Phase::aligning);
    EXPECT_TRUE(goals_.back().focus);
  }
  bool is_sent_to_a_face_in(double duration_s) {
    const auto before = static_cast<std::ptrdiff_t>(goals_.size());
    run(duration_s);
    return std::any_of(goals_.begin() + before, goals_.end(),
                       [](const MotionGoal& goal) { return goal.focus.has_value(); });
  }
};

TEST_F(LampWithALateMotionTest, WhoAnswersWhenTheCamerasHaveFailedIsSentToNoFace) {
  while (!looks_ahead()) tick();
  answers_ = false;
  send_to_the_face();
  EXPECT_TRUE(is_sent_to_a_face_in(1.5)) << "nobody has answered";
  has_cameras_ = false;
  run(3);
  EXPECT_FALSE(is_sent_to_a_face_in(600));
  EXPECT_EQ(task_.trouble(), "no picture has come for 2 s");
  answers_ = true;
  EXPECT_FALSE(is_sent_to_a_face_in(10));
  has_cameras_ = true;
  EXPECT_TRUE(run_until(Phase::holding, 15));
}

TEST_F(LampWithALateMotionTest, WhoAnswersWhenTheCamerasComeBackIsSentToWhereThePatientIsByThen) {
  while (!looks_ahead()) tick();
  answers_ = false;
  send_to_the_face();
  has_cameras_ = false;
  run(600);
  answers_ = has_cameras_ = true;
  mouth_.y() += 0.1;
  const std::size_t goals = goals_.size();
  EXPECT_TRUE(run_until(Phase::holding, 15));
  for (std::size_t i = goals; i < goals_.size(); ++i)
    EXPECT_LT((*goals_[i].focus - mouth_).norm(), 0.01) << "goal " << i;
}

TEST_F(LampWithALateMotionTest, WhoAnswersWhenThePatientHasGoneHelpsToSearch) {
  while (!looks_ahead()) tick();
  answers_ = false;
  send_to_the_face();
  present_ = false;
  no_face_ = "no face in the picture";
  run(5);
  EXPECT_EQ(task_.phase(), Phase::searching);
  EXPECT_FALSE(is_sent_to_a_face_in(600));
  answers_ = true;
  EXPECT_FALSE(is_sent_to_a_face_in(60));
  present_ = true;
  EXPECT_TRUE(run_until(Phase::holding, 30));
}

TEST_F(LampWithALateMotionTest, WhoIsReadyWhenTheFaceIsNotBelievedIsSentToNoFace) {
  while (!looks_ahead()) tick();
  is_ready_ = false;
  send_to_the_face();
  believed_ = false;
  run(3);
  EXPECT_EQ(task_.trouble(), "a face is seen but not believed: nobody tells where it is");
  is_ready_ = true;
  EXPECT_FALSE(is_sent_to_a_face_in(60));
  EXPECT_EQ(task_.phase(), Phase::aligning);
  believed_ = true;
  EXPECT_TRUE(run_until(Phase::holding, 15));
  EXPECT_EQ(task_.trouble(), "");
}

TEST_F(LampWithALateMotionTest, WhoIsSilentBehindARefusalHearsNoRefusalOfAFaceThatIsNotBelieved) {
  ASSERT_TRUE(run_until(Phase::holding, 15));
  reach_m_ = 0.1;
  mouth_.y() += 0.05;
  ASSERT_TRUE(run_until(Phase::unreachable, 10));
  answers_ = false;
  mouth_.y() += 0.05;
  run(1);
  EXPECT_EQ(task_.trouble(), "ik: out_of_reach") << "the last answer";
  believed_ = false;
  run(3);
  EXPECT_EQ(task_.trouble(), "a face is seen but not believed: nobody tells where it is");
  believed_ = true;
  run(1);
  EXPECT_EQ(task_.trouble(), "ik: out_of_reach");
}

TEST_F(LampAlignmentTest, OutOfReachOfAFaceItTriesNoOtherPositionThatIsOld) {
  ASSERT_TRUE(run_until(Phase::holding, 15));
  reach_m_ = 0.1;
  mouth_.y() += 0.05;
  ASSERT_TRUE(run_until(Phase::unreachable, 10));
  for (int refused = 0; refused < 5; ++refused) {
    mouth_.y() += 0.02;
    run(4);
  }
  for (const std::size_t goals = goals_.size(); goals_.size() == goals; tick()) mouth_.y() += 2e-4;
  mouth_.y() += 0.03;
  run(0.5);
  has_cameras_ = false;
  reach_m_ = 10;
  const std::size_t goals = goals_.size();
  run(60);
  EXPECT_EQ(goals_.size(), goals) << "it would be sent 4 s after the last one";
  EXPECT_EQ(task_.trouble(), "no picture has come for 2 s");
  has_cameras_ = true;
  EXPECT_TRUE(run_until(Phase::holding, 15));
}

}  // namespace
}  // namespace armature::task::lamp_alignment
