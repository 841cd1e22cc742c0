// SPDX-License-Identifier: Apache-2.0
// The implants, after the bores: 1. the driver's way, turning, and out, 2. what is not trusted, 3.
// with an operator, and out of a thread.
#include "implant_room_test.hpp"

namespace armature::task::implant {
namespace {

const std::vector<PlannedImplant> kImplants{
    {.above_bottom_m = 0.0005, .length_m = 0.01, .pitch_m = 0.0012},
    {.above_bottom_m = 0.001, .length_m = 0.008, .pitch_m = 0.0008}};

class PlacingTest : public ImplantTest {
 protected:
  void begin_with_implants(const Parameters& parameters = quick()) {
    task_ = Implant{parameters, med7(), file_tool_};
    task_.begin(now());
    task_.see_plan(sites_, kImplants);
  }
  /// By which the end of an implant on the driver is off the site, against its axis into the bone.
  Vector3d implant_at(const ToolPose& tool, std::size_t i) const {
    GuidedChain driver = chain_;
    driver.tip = driver_tip_;
    const Isometry3d image_T_site = Eigen::Translation3d{sites_[i].position} *
                                    std::get<Eigen::Quaterniond>(sites_[i].orientation);
    const Vector3d end =
        flange_at(tool) * driver.flange_T_tool() * Vector3d{0, 0, kImplants[i].length_m};
    return chain_.base_T_site(image_T_site).inverse() * end;
  }
  void expect_implant(const ToolPose& tool, std::size_t i, double above_m) const {
    EXPECT_LT((implant_at(tool, i) - Vector3d{0, 0, -above_m}).norm(), 1e-8) << "implant " << i + 1;
  }
  std::string say(const std::string& word, const std::string& step = "") {
    const auto obeyed = task_.hear({.id = ++said_, .word = word, .step = step}, now());
    return obeyed ? "" : obeyed.error().text;
  }
  std::string asked() const {
    const Procedure& procedure = task_.procedure();
    return procedure.asks() ? procedure.steps()[procedure.step()].name : "";
  }
  void confirm(const std::string& step) {
    for (int i = 0; i < 1000 && asked() != step && !task_.procedure().over(); ++i) {
      this->step();
      if (task_.wants_registration()) task_.see_registration(registered(), now());
      if (!asked().empty() && asked() != step) say("confirm", asked());
    }
    EXPECT_EQ(say("confirm", step), "") << task_.trouble();
  }

  std::uint64_t said_ = 0;
};

TEST_F(PlacingTest, TheDriverGoesThroughTheSitesAfterTheDrillAndOut) {
  begin_with_implants();
  go_to(Phase::drilling);
  const Vector3d came_from = (base_T_flange_ * file_tool_).translation();
  go_to(Phase::changing_tool);
  EXPECT_GT((came_from - goals_.back().pose.position).norm(), 0) << "the drill is out";
  const std::size_t first = goals_.size();
  go_to(Phase::placed);
  // Above, and for each: to the bone, in, out; then over the sites, and to where it came from.
  ASSERT_EQ(goals_.size(), first + 9);
  expect_implant(goals_[first].pose, 0, 0.03);
  for (std::size_t i = 0; i < 2; ++i) {
    const MotionGoal &to_bone = goals_[first + 1 + 3 * i], &in = goals_[first + 2 + 3 * i];
    expect_implant(to_bone.pose, i, 0.012);
    EXPECT_EQ(to_bone.max_speed, 0);
    expect_implant(in.pose, i, kImplants[i].above_bottom_m);
    EXPECT_NEAR(in.max_speed, kImplants[i].pitch_m * 5 / (2 * M_PI), 1e-12);
    expect_implant(goals_[first + 3 + 3 * i].pose, i, 0.03);
  }
  EXPECT_TRUE(task_.procedure().over());
  EXPECT_NEAR(angle_ - 11, 2 * M_PI * (0.0115 / 0.0012 + 0.011 / 0.0008), 1e-6)
      << "both were turned in";
}

TEST_F(PlacingTest, AnImplantThatIsNotTurnedAsItGoesInStopsTheArm) {
  turned_part_ = 0.5;
  begin_with_implants();
  go_to(Phase::refused);
  EXPECT_EQ(task_.trouble(),
            "implant 1: the implant went in by 11.50 mm, and was turned by 4.79 of the 9.58 turns "
            "that its thread wants; 0.2 mm off are allowed");
}

TEST_F(PlacingTest, AHandpieceThatFallsSilentInTheBoneStopsTheArm) {
  Parameters parameters = quick();
  parameters.dwell = 2;
  begin_with_implants(parameters);
  go_to(Phase::placing);
  while (!task_.thread()) step();
  step();
  handpiece_ = false;
  go_to(Phase::refused);
  EXPECT_EQ(task_.trouble().substr(0, 46), "implant 1: the handpiece has not told for 0.52");
}

TEST_F(PlacingTest, WithoutAHandpieceNothingMoves) {
  handpiece_ = false;
  begin_with_implants();
  go_to(Phase::refused);
  EXPECT_EQ(task_.trouble(), "the plan has implants, and no handpiece tells how far it turns them");
  EXPECT_TRUE(goals_.empty());
}

TEST_F(PlacingTest, WaitsForTheDriverInTheHandAsLongAsItTakes) {
  see_driver_ = false;
  begin_with_implants();
  wait(5);
  EXPECT_EQ(task_.phase(), Phase::pivoting);
  see_driver_ = true;
  go_to(Phase::calibrating);
  EXPECT_LT((task_.guidance().driver_chain()->tip - driver_tip_).norm(), 1e-9);
}

TEST_F(PlacingTest, ImplantsThatCannotBeAreToldByNumberAndValue) {
  const auto refusal = [&](std::vector<PlannedImplant> implants) {
    Implant task{quick(), med7(), file_tool_};
    task.begin(now());
    task.see_plan(sites_, implants);
    return task.trouble();
  };
  EXPECT_EQ(refusal({kImplants[0]}), "the plan: 1 implants for 2 sites");
  auto implants = kImplants;
  implants[1].above_bottom_m = 0.012;
  EXPECT_EQ(refusal(implants),
            "the plan: implant 2: its end above the bottom is 12 mm, from 0 to below the bore's "
            "depth, 12, are wanted");
  implants = kImplants;
  implants[0].length_m = NAN;
  EXPECT_EQ(refusal(implants),
            "the plan: implant 1: its length is nan mm, more than 0 and at most 100 are wanted");
  implants = kImplants;
  implants[0].pitch_m = 0;
  EXPECT_EQ(refusal(implants),
            "the plan: implant 1: its pitch is 0 mm, from 0.1 to its length are wanted");
}

class OperatedPlacingTest : public PlacingTest {
 protected:
  OperatedPlacingTest() {
    Parameters parameters = quick();
    parameters.auto_confirm = false;
    begin_with_implants(parameters);
    confirm("implant 1");
  }
  /// In the midst of the way into the thread.
  void stop_in_the_thread() {
    while (!task_.thread()) step();
    const Vector3d in = goals_.back().pose.position;
    base_T_flange_.translation() -= (in - task_.thread()->start) * 0.5;
    done_ = 0;
    step();
  }
};

TEST_F(OperatedPlacingTest, AsksBeforeTheToolChangeAndEveryImplant) {
  std::vector<std::string> names;
  for (const auto& step : task_.procedure().steps()) names.push_back(step.name);
  EXPECT_EQ(names,
            (std::vector<std::string>{"pivot", "calibration", "registration", "approach", "site 1",
                                      "site 2", "withdrawal", "tool change", "second approach",
                                      "implant 1", "implant 2", "last withdrawal"}));
  confirm("implant 2");
  go_to(Phase::placed);
}

TEST_F(OperatedPlacingTest, BackInTheThreadItIsTurnedOutAsSlowlyAndThenLeavesTheMouthFreely) {
  stop_in_the_thread();
  EXPECT_EQ(say("back"), "");
  step();
  step();
  EXPECT_NEAR(goals_.back().max_speed, kImplants[0].pitch_m * 5 / (2 * M_PI), 1e-12);
  expect_implant(goals_.back().pose, 0, 0.012);
  EXPECT_TRUE(task_.thread());
  const std::size_t turned_out = goals_.size();
  for (int i = 0; i < 10 && asked().empty(); ++i) step();
  EXPECT_EQ(asked(), "implant 1") << task_.trouble();
  ASSERT_EQ(goals_.size(), turned_out + 1);
  expect_implant(goals_.back().pose, 0, 0.03);
  EXPECT_EQ(goals_.back().max_speed, 0);
  EXPECT_FALSE(task_.thread());
  EXPECT_NEAR(angle_, 11, 1e-9) << "as far out as it went in";
}

TEST_F(OperatedPlacingTest, AbortedInTheThreadItIsTurnedOutAndTheArmGoesToWhereItCameFrom) {
  stop_in_the_thread();
  EXPECT_EQ(say("abort"), "");
  go_to(Phase::aborted);
  const std::size_t to_mouth = goals_.size() - 3;
  EXPECT_GT(goals_[to_mouth].max_speed, 0);
  expect_implant(goals_[to_mouth].pose, 0, 0.012);
  EXPECT_EQ(goals_[to_mouth + 1].max_speed, 0) << "out of the mouth as fast as any motion";
  expect_implant(goals_[to_mouth + 1].pose, 0, 0.03);
  EXPECT_EQ(goals_.back().max_speed, 0);
  EXPECT_NEAR(angle_, 11, 1e-9) << "as far out as it went in";
  EXPECT_FALSE(task_.thread());
}

TEST_F(OperatedPlacingTest, AbortedAtTheMouthItIsNotSentToWhereItIs) {
  while (!task_.thread()) step();
  base_T_flange_.translation() -= goals_.back().pose.position - task_.thread()->start;
  done_ = 0;
  step();
  EXPECT_EQ(say("abort"), "");
  step();
  step();
  expect_implant(goals_.back().pose, 0, 0.03);
  go_to(Phase::aborted);
}

TEST_F(OperatedPlacingTest, AnAbortLeadsOutAnImplantWhoseHandpieceIsSilent) {
  stop_in_the_thread();
  handpiece_ = false;
  go_to(Phase::held);
  const std::string why = task_.trouble();
  EXPECT_EQ(why.substr(0, 43), "implant 1: the handpiece has not told for 0") << why;
  wait(1);
  EXPECT_EQ(say("abort"), "");
  go_to(Phase::aborted);
  EXPECT_LT((goals_.back().pose.position - goals_[7].pose.position).norm(), 1e-9);
}

TEST_F(OperatedPlacingTest, AHandpieceThatFallsSilentWhileItTurnsOutHoldsTheImplantOnce) {
  stop_in_the_thread();
  EXPECT_EQ(say("abort"), "");
  step();
  handpiece_ = false;
  done_ = 0;  // on its way out
  for (int i = 0; i < 50 && task_.phase() == Phase::aborting; ++i) {
    done_ = 0;
    step();
  }
  EXPECT_EQ(task_.phase(), Phase::held) << "nobody has said yet that it may come out unturned";
  EXPECT_EQ(say("abort"), "");
  go_to(Phase::aborted);
}

TEST_F(OperatedPlacingTest, APlacedImplantStays) {
  for (int i = 0; i < 1000 && asked().empty(); ++i) step();
  EXPECT_EQ(asked(), "implant 2");
  EXPECT_EQ(say("back"), "the implant before stays where it was placed");
}

}  // namespace
}  // namespace armature::task::implant
