// SPDX-License-Identifier: Apache-2.0
// The scenario of a drilling, without topics: 1. from the pivot to the last site, 2. what it does
// not trust, its arm included, 3. bodies that are not seen, 4. a jaw that moves, 5. a motion that
// is refused.
#include <gtest/gtest.h>

#include <cmath>
#include <functional>

#include "implant_room_test.hpp"

namespace armature::task::implant {
namespace {

TEST_F(ImplantTest, GoesFromThePivotThroughAllSites) {
  begin();
  EXPECT_EQ(task_.phase(), Phase::pivoting);
  go_to(Phase::calibrating);
  EXPECT_TRUE(goals_.empty()) << "the arm waits while the drill is in the hand";
  go_to(Phase::registering);
  EXPECT_EQ(goals_.size(), 8u);
  go_to(Phase::drilling);
  EXPECT_LT(
      (task_.guidance().chain().base_T_tracker.matrix() - chain_.base_T_tracker.matrix()).norm(),
      1e-9);
  EXPECT_LT((task_.guidance().chain().tip - chain_.tip).norm(), 1e-9);
  go_to(Phase::drilled);
  ASSERT_EQ(goals_.size(), 12u) << "over the sites, and to where it came from";
  const MotionGoal& bores = goals_[9];
  EXPECT_LT((goals_.back().pose.position - goals_[7].pose.position).norm(), 1e-9);
  ASSERT_EQ(bores.through.size(), 4u);
  expect_tip_at(bores.through[0], 0);
  expect_tip_at(bores.through[3], 1);
  ASSERT_EQ(task_.guidance().forecasts().size(), 2u);
  EXPECT_NEAR(task_.guidance().forecasts()[0].rms_m(), 0.0003, 1e-9)
      << "only the registration errs";
  EXPECT_NEAR(task_.guidance().forecasts()[1].bound95_m(), 0.0004, 1e-9);
  const auto news = task_.take_news();
  ASSERT_EQ(news.size(), 4u);
  EXPECT_EQ(news[2], "registration: the markers fit to 0.40 mm");
  EXPECT_EQ(news[3], "the worst of 2 sites is known to 0.50 mm (95 %)");
  EXPECT_TRUE(task_.take_news().empty());
}

TEST_F(ImplantTest, StaysForAWhileAtEveryBottomWhereItStops) {
  task_ = Implant{quick(true), med7(), file_tool_};
  begin();
  go_to(Phase::drilling);
  step();
  const std::size_t first = goals_.size();
  expect_tip_at(goals_.back().pose, 0);
  wait(0.4);
  EXPECT_EQ(goals_.size(), first);
  wait(0.2);
  ASSERT_EQ(goals_.size(), first + 2) << "out, and into the next";
  expect_tip_at(goals_.back().pose, 1);
  go_to(Phase::drilled);
  EXPECT_EQ(goals_.size(), first + 5) << "and out again, over the sites, and to where it came from";
}

TEST_F(ImplantTest, ADrillThatWasNotAtEveryBottomHasNotDrilled) {
  for (const bool stop_at_sites : {false, true}) {
    task_ = Implant{quick(stop_at_sites), med7(), file_tool_};
    done_ = 0;
    goals_.clear();
    short_m_ = 0;
    begin();
    go_to(Phase::approaching);
    short_m_ = 0.0009;
    go_to(Phase::refused);
    EXPECT_EQ(task_.trouble(),
              "the drill came no nearer than 0.90 mm to the bottom of site 1, 0.3 mm are allowed");
    EXPECT_EQ(goals_.size(), 10u) << "it does not go on to site 2 where it stops";
  }
}

TEST_F(ImplantTest, DoesNotAskForARegistrationBeforeThereIsAPlan) {
  task_.begin(now());
  while (task_.phase() != Phase::registering) step();
  EXPECT_FALSE(task_.wants_registration());
  task_.see_plan(sites_);
  EXPECT_TRUE(task_.wants_registration());
}

TEST_F(ImplantTest, ASitesNumbersAreChecked) {
  const auto refusal = [&](std::vector<ToolPose> sites) {
    Implant task{quick(), med7(), file_tool_};
    task.begin(now());
    task.see_plan(sites);
    EXPECT_EQ(task.phase(), Phase::refused);
    return task.trouble();
  };
  EXPECT_EQ(refusal({}), "the plan has no sites");
  sites_[1].position.y() = NAN;
  EXPECT_EQ(refusal(sites_).substr(0, 16), "the plan: site 2");
  sites_[1] = sites_[0];
  sites_[1].orientation = Eigen::Quaterniond{0, 0, 0, 0};
  EXPECT_EQ(refusal(sites_).substr(0, 16), "the plan: site 2");
}

TEST_F(ImplantTest, TwoSitesAtOnePlaceAreRefusedBeforeAnythingMoves) {
  sites_.push_back(sites_[0]);
  begin();
  EXPECT_EQ(task_.phase(), Phase::refused);
  EXPECT_EQ(
      task_.trouble(),
      "the plan: the bores of sites 1 and 3 come as near as 0.00 mm to each other, axis to axis; "
      "'min_site_distance_mm' is 7");
  wait(1);
  EXPECT_TRUE(goals_.empty());
}

TEST_F(ImplantTest, DoesNotTrustATipThatDidNotStandStill) {
  jitter_m_ = 0.002;
  begin();
  go_to(Phase::refused);
  EXPECT_EQ(task_.trouble().substr(0, 29), "pivot: the tip stood still to");
}

TEST_F(ImplantTest, DoesNotTrustPosesThatDoNotFit) {
  begin();
  go_to(Phase::calibrating);
  jitter_m_ = 0.002;
  go_to(Phase::refused);
  EXPECT_EQ(task_.trouble().substr(0, 27), "hand-eye: the poses fit to ");
}

TEST_F(ImplantTest, DoesNotTrustARegistrationThatIsTooBad) {
  const auto refusal = [&](const std::function<void(RegisteredJaw&)>& spoil) {
    task_ = Implant{quick(), med7(), file_tool_};
    done_ = 0;
    begin();
    while (task_.phase() != Phase::registering) step();
    RegisteredJaw jaw = registered();
    spoil(jaw);
    task_.see_registration(jaw, now());
    if (task_.phase() == Phase::locating) wait(0.2);
    EXPECT_EQ(task_.phase(), Phase::refused);
    return task_.trouble();
  };
  EXPECT_EQ(refusal([](RegisteredJaw& jaw) { jaw.fiducial_error_m = 0.002; }),
            "the markers fit to 2.00 mm rms, 1.5 mm are allowed");
  EXPECT_EQ(refusal([](RegisteredJaw& jaw) { jaw.sites[1].error_95_m = 0.003; }),
            "site 2 is known to 3.00 mm (95 %), 1.5 mm are required");
  EXPECT_EQ(refusal([](RegisteredJaw& jaw) { jaw.sites[0].error_95_m = NAN; }),
            "site 1 is known to nan mm (95 %), 1.5 mm are required");
  EXPECT_EQ(refusal([](RegisteredJaw& jaw) { jaw.sites.pop_back(); }),
            "the registration tells the error of 1 sites, the plan has 2");
}

TEST_F(ImplantTest, AnArmOnItsWayHoldsWhateverTheReason) {
  task_.begin(now());
  go_to(Phase::calibrating);
  while (goals_.empty()) step();
  task_.see_plan({});
  step();
  EXPECT_EQ(task_.phase(), Phase::refused);
  EXPECT_EQ(goals_.back().mode, MotionMode::hold);
}

TEST_F(ImplantTest, ABodyThatIsNotSeenIsNamedAndAMovingArmHolds) {
  see_drill_ = false;
  begin();
  go_to(Phase::refused);
  EXPECT_EQ(task_.trouble(),
            "pivot: the tracker has not seen the drill in the hand for 0.52 s: it sends nothing");
  for (bool* body : {&see_flange_, &see_jaw_}) {
    task_ = Implant{quick(true), med7(), file_tool_};
    done_ = 0;
    see_drill_ = see_flange_ = see_jaw_ = true;
    begin();
    go_to(Phase::drilling);
    done_ = 0;  // on its way
    *body = false;
    go_to(Phase::refused);
    step();
    EXPECT_EQ(goals_.back().mode, MotionMode::hold);
    EXPECT_EQ(task_.trouble(), body == &see_jaw_
                                   ? "the tracker has not seen the jaw for 0.52 s: it sends nothing"
                                   : "the tracker has not seen the flange for 0.52 s: it sends "
                                     "nothing");
  }
}

TEST_F(ImplantTest, AJawThatIsNotSeenIsNotDrilled) {
  see_jaw_ = false;
  begin();
  go_to(Phase::refused);
  EXPECT_EQ(task_.trouble(), "the tracker has not seen the jaw for 0.52 s: it sends nothing");
  EXPECT_EQ(goals_.size(), 8u) << "only the calibration's";
}

TEST_F(ImplantTest, AFlangeThatIsNeverSeenEndsTheCalibrationAsSoonAsItCannotSucceed) {
  see_flange_ = false;
  begin();
  go_to(Phase::refused);
  EXPECT_EQ(task_.trouble(),
            "hand-eye: 5 of 8 poses at most, 6 are needed; pose 3: the tracker has not seen the "
            "flange for 0.52 s: it sends nothing");
}

TEST_F(ImplantTest, AJawThatMovesStopsTheArm) {
  begin();
  go_to(Phase::drilling);
  done_ = 0;
  for (int i = 0; i < 100; ++i) {  // a tracker that errs
    chain_.tracker_T_patient.translate(Vector3d{0, i % 2 ? 0.0018 : -0.0018, 0});
    step();
  }
  EXPECT_EQ(task_.phase(), Phase::drilling);
  chain_.tracker_T_patient.translate(Vector3d{0, 0.0018, 0});
  wait(0.5);
  EXPECT_EQ(task_.phase(), Phase::refused);
  EXPECT_EQ(task_.trouble().substr(0, 21), "the jaw has moved by ");
  EXPECT_EQ(goals_.back().mode, MotionMode::hold);
}

TEST_F(ImplantTest, AJawThatTurnsAboutTheFirstSiteStopsTheArmToo) {
  begin();
  go_to(Phase::drilling);
  done_ = 0;
  const Vector3d site = task_.guidance().chain().patient_T_image * sites_[0].position;
  chain_.tracker_T_patient = chain_.tracker_T_patient * Eigen::Translation3d{site} *
                             Eigen::AngleAxisd{10 * M_PI / 180, Vector3d::UnitZ()} *
                             Eigen::Translation3d{-site};
  wait(0.5);
  EXPECT_EQ(task_.phase(), Phase::refused);
  EXPECT_EQ(task_.trouble().substr(0, 21), "the jaw has moved by ");
}

TEST_F(ImplantTest, AJawThatMovesWhileItsPlaceIsAveragedIsNotDrilled) {
  Parameters parameters = quick();
  parameters.jaw_samples = 60;
  const auto locate = [&](double step_m) {
    task_ = Implant{parameters, med7(), file_tool_};
    done_ = 0;
    begin();
    go_to(Phase::locating);
    for (int i = 0; i < 70 && task_.phase() == Phase::locating; ++i) {
      chain_.tracker_T_patient.translate(Vector3d{0, step_m, 0});
      step();
    }
    return task_.trouble();
  };
  EXPECT_EQ(locate(0.015e-3), "") << "0.9 mm in all";
  const std::string trouble = locate(0.03e-3);
  EXPECT_EQ(trouble.substr(0, 17), "the jaw moved by ") << trouble;
  EXPECT_NE(trouble.find(" mm while its place was averaged, 1 mm are allowed"), std::string::npos);
  EXPECT_EQ(task_.phase(), Phase::refused);
}

TEST_F(ImplantTest, AJawThatJumpsToAndFroBetweenTwoPlacesIsNotDrilledBetweenThem) {
  Parameters parameters = quick();
  parameters.jaw_samples = 60;
  const auto locate = [&](double apart_m) {
    task_ = Implant{parameters, med7(), file_tool_};
    done_ = 0;
    begin();
    go_to(Phase::locating);
    for (int i = 0; i < 70 && task_.phase() == Phase::locating; ++i) {
      chain_.tracker_T_patient.translate(Vector3d{0, i % 2 == 0 ? apart_m : -apart_m, 0});
      step();
    }
    return task_.trouble();
  };
  EXPECT_EQ(locate(0.0015), "") << "0.75 mm to either side of the mean";
  EXPECT_EQ(locate(0.003),
            "the samples of the jaw scatter by 1.51 mm (rms) while its place is averaged, 1 mm are "
            "allowed");
}

TEST_F(ImplantTest, AJawThatJumpsBetweenFewSamplesIsFoundToo) {
  begin();
  go_to(Phase::locating);
  for (int i = 0; i < 5 && task_.phase() == Phase::locating; ++i) {
    if (i == 2) chain_.tracker_T_patient.translate(Vector3d{0, 0.002, 0});
    step();
  }
  EXPECT_EQ(task_.trouble(),
            "the jaw moved by 2.00 mm while its place was averaged, 1 mm are allowed");
}

TEST_F(ImplantTest, StopsWithTheReasonWhenTheMotionRefuses) {
  begin();
  go_to(Phase::drilling);
  task_.hear({.goal_id = goals_.back().id, .state = Report::failed, .stage = "ik", .reason = "far"},
             now());
  EXPECT_EQ(task_.phase(), Phase::refused);
  EXPECT_EQ(task_.trouble(), "sites 1 to 2: ik: far");
}

TEST_F(ImplantTest, AWayThatIsRefusedIsNamed) {
  task_ = Implant{quick(true), med7(), file_tool_};
  begin();
  go_to(Phase::approaching);
  task_.hear({.goal_id = goals_.back().id, .state = Report::failed, .stage = "ik", .reason = "far"},
             now());
  EXPECT_EQ(task_.trouble(), "above site 1: ik: far");
  task_ = Implant{quick(true), med7(), file_tool_};
  done_ = 0;
  begin();
  go_to(Phase::drilling);
  wait(0.7);
  task_.hear({.goal_id = goals_.back().id, .state = Report::failed, .stage = "ik", .reason = "far"},
             now());
  EXPECT_EQ(task_.trouble(), "site 2: ik: far");
}

TEST_F(ImplantTest, ACalibrationPoseThatCannotBeReachedIsLeftOut) {
  begin();
  go_to(Phase::calibrating);
  while (goals_.empty()) step();
  task_.hear({.goal_id = goals_.back().id, .state = Report::failed, .stage = "ik", .reason = "far"},
             now());
  go_to(Phase::registering);
  const auto news = task_.take_news();
  EXPECT_EQ(news.back().substr(0, 28), "hand-eye: 7 of 8 poses fit t");
  EXPECT_NE(news.back().find("left out: pose 1: ik: far"), std::string::npos);
}

TEST_F(ImplantTest, AStopWhileItCalibratesEndsItThoughThePosesThatItHasWouldDo) {
  begin();
  go_to(Phase::calibrating);
  while (goals_.size() < 7) step();  // six are enough
  task_.hear({.goal_id = goals_.back().id,
              .state = Report::failed,
              .stage = "stop",
              .reason = "stopped until it is rearmed"},
             now());
  EXPECT_EQ(task_.phase(), Phase::refused);
  EXPECT_EQ(task_.trouble(), "hand-eye: stop: stopped until it is rearmed");
  wait(5);
  EXPECT_EQ(goals_.size(), 7u) << "or the arm would move once it is rearmed";
}

TEST_F(ImplantTest, AnArmWhoseEncodersScatterIsCalibratedAndLocated) {
  arm_noise_m_ = 2e-5;  // along each axis
  begin();
  go_to(Phase::drilled);
}

TEST_F(ImplantTest, AnArmThatNeverStandsStillIsSaidAndNotWaitedFor) {
  arm_noise_m_ = 1e-3;
  begin();
  for (int i = 0; i < 2000 && !task_.procedure().over(); ++i) step();
  EXPECT_EQ(task_.phase(), Phase::refused);
  EXPECT_NE(task_.trouble().find("hand-eye: 5 of 8 poses at most"), std::string::npos)
      << task_.trouble();
  EXPECT_NE(task_.trouble().find("the arm does not stand still within 5 s"), std::string::npos)
      << task_.trouble();
}

TEST_F(ImplantTest, AnArmThatDoesNotStandStillWhileTheJawIsLocatedIsSaid) {
  begin();
  go_to(Phase::registering);
  arm_noise_m_ = 1e-3;
  for (int i = 0; i < 500 && !task_.procedure().over(); ++i) {
    step();
    if (task_.wants_registration()) task_.see_registration(registered(), now());
  }
  EXPECT_EQ(task_.phase(), Phase::refused);
  EXPECT_EQ(task_.trouble().substr(0, 39), "the arm does not stand still within 5 s")
      << task_.trouble();
}

}  // namespace
}  // namespace armature::task::implant
