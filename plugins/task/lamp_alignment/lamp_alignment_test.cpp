// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <numbers>

#include "lamp_room_test.hpp"

namespace armature::task::lamp_alignment {
namespace {

constexpr double kDegree = std::numbers::pi / 180;

TEST_F(LampAlignmentTest, ChecksTheLightThenSearchesThenAlignsAndHolds) {
  EXPECT_EQ(task_.phase(), Phase::checking_light);
  ASSERT_TRUE(run_until(Phase::searching, 1));
  EXPECT_EQ(task_.view(), 1u);
  EXPECT_FALSE(task_.capture());
  ASSERT_TRUE(run_until(Phase::aligning, 5));
  EXPECT_EQ(task_.view(), 2u);  // straight ahead
  EXPECT_TRUE(task_.capture());
  ASSERT_TRUE(run_until(Phase::holding, 10));
  const MotionGoal& last = goals_.back();
  EXPECT_NEAR((last.pose.position - Eigen::Vector3d(1.05, 0, 0.45)).norm(), 0, 0.01);
  EXPECT_NEAR((std::get<Direction>(last.pose.orientation).unit - Eigen::Vector3d::UnitX()).norm(),
              0, 0.02);
  EXPECT_NEAR((*last.focus - mouth_).norm(), 0, 0.001);
}

TEST_F(LampAlignmentTest, DoesNotReplanWhileEverythingIsStill) {
  ASSERT_TRUE(run_until(Phase::holding, 15));
  const std::size_t goals = goals_.size();
  run(120);
  EXPECT_EQ(goals_.size(), goals);
  EXPECT_EQ(task_.phase(), Phase::holding);
}

TEST_F(LampAlignmentTest, AnEstimateThatDisagreesWithTheOthersSendsNoGoalWhileItHolds) {
  ASSERT_TRUE(run_until(Phase::holding, 15));
  const std::size_t goals = goals_.size();
  for (const double off_m : {0.04, 0.08, 0.1, 0.15, 0.25}) {
    for (int axis = 0; axis < 3; ++axis) {
      phantom_ = off_m * Eigen::Vector3d::Unit(axis);
      run(1);
      ASSERT_TRUE(phantom_.isZero()) << "it was seen";
      EXPECT_EQ(goals_.size(), goals) << off_m << " m along axis " << axis;
      EXPECT_EQ(task_.phase(), Phase::holding);
    }
  }
}

TEST_F(LampAlignmentTest, AnEstimateThatDisagreesWithTheOthersIsNeverItsGoalOnTheWay) {
  ASSERT_TRUE(run_until(Phase::aligning, 10));
  const std::size_t first = goals_.size();
  for (int k = 0; k < 300 && task_.phase() != Phase::holding; ++k) {
    if (k % 40 == 20) phantom_ = {-0.1, 0.05, 0};
    tick();
  }
  EXPECT_EQ(task_.phase(), Phase::holding);
  ASSERT_GT(goals_.size(), 0u);
  for (std::size_t i = first; i < goals_.size(); ++i)
    EXPECT_LT((*goals_[i].focus - mouth_).norm(), 0.003) << "goal " << i;
}

TEST_F(LampAlignmentTest, AnEstimateThatDisagreesWithTheOthersSendsNoGoalAfterAStop) {
  ASSERT_TRUE(run_until(Phase::aligning, 10));
  tick();
  stop();
  run(1);
  rearm();
  lamp_.orientation = Direction{Eigen::Vector3d::UnitX()};
  const std::size_t goals = goals_.size();
  for (int k = 0; k < 10; ++k) {
    phantom_ = {-0.1, 0.05, 0};
    run(1);
    ASSERT_TRUE(phantom_.isZero()) << "it was seen";
  }
  EXPECT_EQ(goals_.size(), goals);
}

TEST_F(LampAlignmentTest, FollowsThePatient) {
  ASSERT_TRUE(run_until(Phase::holding, 15));
  for (int k = 0; k < 50; ++k) {  // 50 mm and 10 degrees in one second
    mouth_.y() += 0.001;
    normal_ = Eigen::AngleAxisd(0.2 * kDegree, Eigen::Vector3d::UnitZ()) * normal_;
    tick();
  }
  EXPECT_EQ(task_.phase(), Phase::following);
  ASSERT_TRUE(run_until(Phase::holding, 6));
  EXPECT_NEAR((*goals_.back().focus - mouth_).norm(), 0, 0.002);
  EXPECT_NEAR((std::get<Direction>(goals_.back().pose.orientation).unit + normal_).norm(), 0, 0.02);
}

TEST_F(LampAlignmentTest, GoesAlongWithAPatientWhoMovesAndHoldsWhereHeStops) {
  ASSERT_TRUE(run_until(Phase::holding, 15));
  const std::size_t before = goals_.size();
  velocity_ = {0, 0.05, 0};
  for (int k = 0; k < 100; ++k) {
    mouth_ += 0.02 * velocity_;
    tick();
  }
  EXPECT_EQ(task_.phase(), Phase::following);
  ASSERT_GT(goals_.size(), before + 50) << "one in every step";
  const MotionGoal& along = goals_.back();
  EXPECT_EQ(along.mode, MotionMode::tracking);
  EXPECT_NEAR((along.velocity - velocity_).norm(), 0, 1e-9);
  EXPECT_NEAR((*along.focus - mouth_).norm(), 0, 0.003) << "where he is now, between two pictures";
  velocity_.setZero();
  ASSERT_TRUE(run_until(Phase::holding, 10));
  EXPECT_EQ(goals_.back().mode, MotionMode::planned);
  EXPECT_NEAR((*goals_.back().focus - mouth_).norm(), 0, 0.002);
}

TEST_F(LampAlignmentTest, AFaceThatIsElsewhereAtOnceIsNotGoneAlongWithBeforeTheLampIsNearIt) {
  ASSERT_TRUE(run_until(Phase::holding, 15));
  for (const bool goes_on : {false, true}) {
    velocity_ = {0, 0.05, 0};
    for (int k = 0; k < 25; ++k) {
      mouth_ += 0.02 * velocity_;
      tick();
    }
    ASSERT_EQ(goals_.back().mode, MotionMode::tracking);
    const std::size_t under_way = goals_.size();
    const Eigen::Vector3d was_at = mouth_;
    mouth_.y() += 0.3;
    if (!goes_on) velocity_.setZero();
    run(0.9);
    for (std::size_t i = under_way; i < goals_.size(); ++i) {
      EXPECT_TRUE(goals_[i].mode == MotionMode::planned || (*goals_[i].focus - was_at).norm() < 0.1)
          << "goal " << i;
    }
    velocity_.setZero();
    ASSERT_TRUE(run_until(Phase::holding, 10));
    EXPECT_NEAR((*goals_.back().focus - mouth_).norm(), 0, 0.003);
  }
}

TEST_F(LampAlignmentTest, AStopWhileItGoesAlongIsFollowedByNothingThoughItIsToldLate) {
  ASSERT_TRUE(run_until(Phase::holding, 15));
  velocity_ = {0, 0.05, 0};
  for (int k = 0; k < 25; ++k) {
    mouth_ += 0.02 * velocity_;
    tick();
  }
  ASSERT_EQ(goals_.back().mode, MotionMode::tracking);
  late_by_ = 2;  // ticks
  stop();
  run(2);
  EXPECT_EQ(task_.phase(), Phase::unreachable);
  EXPECT_EQ(task_.trouble(), "stop: stopped until it is rearmed");
  rearm();
  const std::size_t goals = goals_.size();
  run(5);
  EXPECT_EQ(goals_.size(), goals);
}

TEST_F(LampAlignmentTest, GoesAlongAlsoWhenItHasBegunToGoToWhereHeWas) {
  ASSERT_TRUE(run_until(Phase::holding, 15));
  mouth_.y() += 0.015;  // as an estimate tells it that takes him to be still
  ASSERT_TRUE(run_until(Phase::following, 1));
  ASSERT_EQ(goals_.back().mode, MotionMode::planned);
  velocity_ = {0, 0.05, 0};
  for (int k = 0; k < 25; ++k) {
    mouth_ += 0.02 * velocity_;
    tick();
  }
  EXPECT_EQ(goals_.back().mode, MotionMode::tracking) << "before the planned way is at its end";
}

TEST_F(LampAlignmentTest, StopsWhenAFaceThatItGoesAlongWithIsSeenNoMore) {
  ASSERT_TRUE(run_until(Phase::holding, 15));
  velocity_ = {0, 0.05, 0};
  for (int k = 0; k < 50; ++k) {
    mouth_ += 0.02 * velocity_;
    tick();
  }
  ASSERT_EQ(goals_.back().mode, MotionMode::tracking);
  present_ = false;
  run(0.7);
  EXPECT_EQ(goals_.back().mode, MotionMode::planned);
  EXPECT_TRUE(run_until(Phase::searching, 5));
}

TEST_F(LampAlignmentTest, RatesThatNobodyHasAreNotBelieved) {
  ASSERT_TRUE(run_until(Phase::holding, 15));
  velocity_ = {0, 5, 0};
  mouth_.y() += 0.005;
  run(0.4);
  ASSERT_EQ(goals_.back().mode, MotionMode::tracking);
  EXPECT_NEAR(goals_.back().velocity.norm(), 0.08, 1e-9);
}

TEST_F(LampAlignmentTest, WaitsForAFaceThatIsFoundInEveryOtherPicture) {
  flickers_ = true;
  ASSERT_TRUE(run_until(Phase::aligning, 6));
  EXPECT_EQ(task_.view(), 2u);
}

TEST_F(LampAlignmentTest, MovesForAFaceOnlyOnceThreePicturesConfirmIt) {
  const auto see = [&](int measurements) {
    task_.see(FaceEstimate{
        .stamp = now_, .mouth = mouth_, .normal = normal_, .measurements = measurements});
    task_.step(now_);
  };
  for (int phantom = 0; phantom < 20; ++phantom) {
    see(1);
    see(2);
  }
  EXPECT_EQ(task_.phase(), Phase::checking_light);
  see(3);
  EXPECT_EQ(task_.phase(), Phase::aligning);
}

TEST_F(LampAlignmentTest, AveragesWhatWasMeasuredAndNothingThatWasPredicted) {
  ASSERT_TRUE(run_until(Phase::aligning, 10));
  predicts_ = true;
  run(5);
  EXPECT_EQ(task_.phase(), Phase::aligning) << "at rest, and forty predictions judge nothing";
  predicts_ = false;
  EXPECT_TRUE(run_until(Phase::holding, 6));
}

TEST_F(LampAlignmentTest, HoldsWhileAFaceIsSeenButNotBelievedAndSaysWhy) {
  ASSERT_TRUE(run_until(Phase::holding, 15));
  believed_ = false;
  const std::size_t goals = goals_.size();
  run(3);
  EXPECT_EQ(task_.trouble(), "a face is seen but not believed: nobody tells where it is");
  task_.see_no_estimate("the mouth lies 22 mm before the face: something covers it");
  run(60);
  EXPECT_EQ(task_.phase(), Phase::holding);
  EXPECT_EQ(goals_.size(), goals);
  EXPECT_EQ(
      task_.trouble(),
      "a face is seen but not believed: the mouth lies 22 mm before the face: something covers it");
  believed_ = true;
  run(1);
  EXPECT_EQ(task_.trouble(), "");
  believed_ = present_ = false;
  EXPECT_TRUE(run_until(Phase::searching, 3)) << "no face is in the pictures any more";
}

TEST_F(LampAlignmentTest, OutOfReachOfAFaceThatIsSeenButNotBelievedItStaysToo) {
  ASSERT_TRUE(run_until(Phase::aligning, 10));
  mouth_.x() = 3;
  reach_m_ = 2;
  ASSERT_TRUE(run_until(Phase::unreachable, 10));
  believed_ = false;
  task_.see_no_estimate("something covers it");
  const std::size_t goals = goals_.size();
  run(20);
  EXPECT_EQ(task_.phase(), Phase::unreachable);
  EXPECT_LE(goals_.size(), goals + 1);
  EXPECT_EQ(task_.trouble(), "a face is seen but not believed: something covers it");
}

TEST_F(LampAlignmentTest, SearchesAgainWhenTheFaceIsLostAndStartsWhereItWas) {
  ASSERT_TRUE(run_until(Phase::holding, 15));
  present_ = false;
  run(1.5);
  EXPECT_EQ(task_.phase(), Phase::holding);
  ASSERT_TRUE(run_until(Phase::searching, 2));
  EXPECT_NEAR(std::get<Direction>(goals_.back().pose.orientation).unit.x(), 1, 1e-9);
  run(60);
  EXPECT_EQ(task_.phase(), Phase::searching);
  present_ = true;
  ASSERT_TRUE(run_until(Phase::holding, 30));
}

TEST_F(LampAlignmentTest, LooksAtAllNinePosesAndBeginsAgain) {
  present_ = false;
  run(0.3);
  std::set<std::size_t> views;
  for (int k = 0; k < 1200; ++k) {
    tick();
    views.insert(task_.view());
  }
  EXPECT_EQ(views, (std::set<std::size_t>{1, 2, 3, 4, 5, 6, 7, 8, 9}));
}

TEST_F(LampAlignmentTest, HoldsAndSaysWhyWhenTheFaceCannotBeReached) {
  ASSERT_TRUE(run_until(Phase::aligning, 10));
  mouth_.x() = 3;
  reach_m_ = 2;
  ASSERT_TRUE(run_until(Phase::unreachable, 10));
  EXPECT_EQ(task_.trouble(), "ik: out_of_reach");
  mouth_.x() = 1.5;
  ASSERT_TRUE(run_until(Phase::holding, 10));
  EXPECT_EQ(task_.trouble(), "");
}

TEST_F(LampAlignmentTest, StaysUnreachableAndWaitsTwiceAsLongAfterEachRefusal) {
  ASSERT_TRUE(run_until(Phase::aligning, 10));
  mouth_.x() = 3;
  reach_m_ = 2;
  ASSERT_TRUE(run_until(Phase::unreachable, 10));
  std::vector<double> tried_at;
  for (int k = 0; k < 1000; ++k) {
    const std::size_t before = goals_.size();
    tick();
    ASSERT_EQ(task_.phase(), Phase::unreachable) << "after " << 0.02 * k << " s";
    ASSERT_EQ(task_.trouble(), "ik: out_of_reach");
    if (goals_.size() > before) tried_at.push_back(0.02 * k);
  }
  ASSERT_GE(tried_at.size(), 7u);
  const std::vector<double> waits{0.5, 1, 2, 4, 4, 4};
  for (std::size_t i = 0; i < waits.size(); ++i)
    EXPECT_NEAR(tried_at[i + 1] - tried_at[i], waits[i], 0.13) << i;
  mouth_.x() = 1.5;
  EXPECT_TRUE(run_until(Phase::holding, 10));
}

TEST_F(LampAlignmentTest, IsUnreachableWhenEverySearchPoseFailsAndTriesOneEachSecond) {
  reach_m_ = 0.1;
  ASSERT_TRUE(run_until(Phase::no_view, 1));
  EXPECT_EQ(goals_.size(), 9u);
  EXPECT_STREQ(to_string(task_.phase()), "unreachable");
  EXPECT_EQ(task_.trouble(), "every search pose failed, the last one: ik: out_of_reach");
  EXPECT_TRUE(task_.capture());
  for (int k = 0; k < 500; ++k) {
    tick();
    ASSERT_EQ(task_.phase(), Phase::no_view) << "after " << 0.02 * k << " s";
    ASSERT_EQ(task_.trouble(), "every search pose failed, the last one: ik: out_of_reach");
    ASSERT_TRUE(task_.capture());
  }
  EXPECT_EQ(goals_.size(), 9u + 10);
  reach_m_ = 10;
  ASSERT_TRUE(run_until(Phase::searching, 2));
  EXPECT_EQ(task_.trouble(), "");
  EXPECT_FALSE(task_.capture());
  EXPECT_TRUE(run_until(Phase::holding, 30));
}

TEST_F(LampAlignmentTest, AStopOnTheWayToTheFaceIsFollowedByNothingUntilThePatientMoves) {
  ASSERT_TRUE(run_until(Phase::aligning, 10));
  tick();
  expect_nothing_to_move_because_of_a_rearm(Phase::unreachable);
  mouth_.y() += 0.02;
  EXPECT_TRUE(run_until(Phase::holding, 10));
}

TEST_F(LampAlignmentTest, AStopInTheSearchEndsItUntilAFaceIsSeen) {
  present_ = false;
  ASSERT_TRUE(run_until(Phase::searching, 1));
  run(0.5);
  expect_nothing_to_move_because_of_a_rearm(Phase::no_view);
  present_ = true;
  EXPECT_TRUE(run_until(Phase::holding, 10));
}

TEST_F(LampAlignmentTest, AlignsWithAFaceThatComesBeforeItThoughNoSearchPoseIsInReach) {
  present_ = false;
  reach_m_ = 0.1;
  ASSERT_TRUE(run_until(Phase::no_view, 1));
  reach_m_ = 10;
  lamp_.orientation = Direction{Eigen::Vector3d::UnitX()};
  present_ = true;
  ASSERT_TRUE(run_until(Phase::aligning, 0.4));
  EXPECT_EQ(task_.trouble(), "");
  EXPECT_TRUE(run_until(Phase::holding, 10));
}

TEST_F(LampAlignmentTest, TellsOfAViewThatItLeavesThatAFaceWasSeenThereAndWhyItWasNotBelieved) {
  believed_ = false;
  while (task_.view() < 3) {
    tick();
    const bool before_the_face = task_.view() == 2;
    if (before_the_face) task_.see_no_estimate("the pictures are not rectified");
  }
  EXPECT_EQ(task_.trouble(),
            "in view 2 a face was seen but not believed: the pictures are not rectified");
  while (task_.view() < 4) tick();
  EXPECT_EQ(task_.trouble(), "") << "none was seen there";
}

TEST_F(LampAlignmentTest, GoesToNoFaceThatIsNotWherePatientsAreAndSearchesOn) {
  task_ = LampAlignment{
      Parameters{
          .min_patient = {0.9, -0.6, -0.1}, .max_patient = {1.9, 0.6, 1.1}, .auto_confirm = true},
      0.08};
  for (const Eigen::Vector3d& poster : {Eigen::Vector3d{1.62, 1.22, 0.42}, {2.32, 0.02, 0.42}}) {
    mouth_ = poster;
    run(15);
    EXPECT_EQ(task_.phase(), Phase::searching);
    while (task_.view() != 3) tick();
    EXPECT_EQ(task_.trouble(),
              fmt::format("in view 2 a face was seen but not believed: a face at ({:.1f}, {:.1f}, "
                          "0.4) m is not where patients are",
                          poster.x(), poster.y()));
  }
  mouth_ = {1.6, 0.5, 0.4};
  EXPECT_TRUE(run_until(Phase::holding, 30));
}

TEST_F(LampAlignmentTest, SearchesForAPatientWhoHasGoneThoughAFaceElsewhereStaysInTheView) {
  task_ = LampAlignment{
      Parameters{
          .min_patient = {0.9, -0.6, -0.1}, .max_patient = {1.9, 0.6, 1.1}, .auto_confirm = true},
      0.08};
  ASSERT_TRUE(run_until(Phase::holding, 15));
  mouth_ = {2.32, 0.02, 0.42};
  measurements_ = 0;
  EXPECT_TRUE(run_until(Phase::searching, 6));
}

TEST_F(LampAlignmentTest, TellsAtTheEndOfARoundWhyNoViewGaveAFaceEachReasonOnce) {
  present_ = false;
  std::vector<std::string> told;
  for (int k = 0; k < 1500; ++k) {
    no_face_ = task_.view() == 4 ? "on the wrong side" : "no face in the left image";
    tick();
    if (told.empty() ? !task_.trouble().empty() : told.back() != task_.trouble())
      told.push_back(task_.trouble());
  }
  ASSERT_GE(told.size(), 3u);
  EXPECT_EQ(told[0], "no view gave a face: no face in the left image; on the wrong side");
  EXPECT_EQ(told[1], "");
  EXPECT_EQ(told[2], told[0]);
}

TEST_F(LampAlignmentTest, TellsWhyTheFaceWasLost) {
  ASSERT_TRUE(run_until(Phase::holding, 15));
  present_ = false;
  task_.see_no_estimate("the mouth would be 0.150 m away");
  ASSERT_TRUE(run_until(Phase::searching, 3));
  EXPECT_EQ(task_.trouble(), "the face was lost: the mouth would be 0.150 m away");
  present_ = true;
  ASSERT_TRUE(run_until(Phase::holding, 30));
  present_ = false;
  ASSERT_TRUE(run_until(Phase::searching, 3));
  EXPECT_EQ(task_.trouble(), "") << "a reason from before the newest estimate is none";
}

TEST_F(LampAlignmentTest, SaysWhatTheLightCannotMend) {
  gain_ = 0.1;
  ASSERT_TRUE(run_until(Phase::searching, 15));
  EXPECT_EQ(task_.trouble(), "the pictures are too dark, and the light is at its brightest");
  gain_ = 1;
  EXPECT_TRUE(run_until(Phase::holding, 25));
  EXPECT_EQ(task_.trouble(), "");
}

TEST_F(LampAlignmentTest, TheLampGetsTheLevelOfTheStartAtOnce) {
  for (const double level : {0.0, 1.0}) {
    task_ = LampAlignment{Parameters{.light_level = level, .auto_confirm = true}, 0.08};
    light_ = 0.5;  // as it was before
    tick();
    EXPECT_EQ(light_, level);
  }
  gain_ = 0.5;
  EXPECT_TRUE(run_until(Phase::holding, 15));
  EXPECT_EQ(task_.trouble(), "") << "with the light it is bright enough";
}

TEST_F(LampAlignmentTest, RaisesTheLightInADarkRoomBeforeItSearches) {
  gain_ = 0.3;
  ASSERT_TRUE(run_until(Phase::searching, 5));
  EXPECT_NEAR(light_, 0.7, 1e-9);  // 0.3 (100 + 200 * 0.7) = 72, the first above 70
  EXPECT_TRUE(run_until(Phase::holding, 15));
}

}  // namespace
}  // namespace armature::task::lamp_alignment
