// SPDX-License-Identifier: Apache-2.0
// Several targets that are tracked come in one step of motion: only the newest costs a search.
#include <gtest/gtest.h>

#include "armature/motion/motion_harness_test.hpp"

namespace armature {
namespace {

using Histories = std::vector<std::string>;

int asked = 0;  // solvers, by anybody

class CountedGantryIk : public test::GantryIk {
 public:
  IkStatus solve(const IkGoal& goal, const JointVector& near, IkBranches& out,
                 IkState& state) const override {
    ++asked;
    return GantryIk::solve(goal, near, out, state);
  }
};

PluginRegistry& with_counted_ik() {
  static PluginRegistry& made = []() -> PluginRegistry& {
    test::plugins().add<CountedGantryIk>("{armature_plugin: 1, id: ik/counted, kind: ik}");
    return test::plugins();
  }();
  return made;
}

ComponentHarness::Options motion_with_counted_ik() {
  ComponentHarness::Options options = test::motion_with("");
  options.component.replace(options.component.find("ik/gantry"), 9, "ik/counted");
  return options;
}

/// Motion of an arm that stands at the gantry's origin.
class TrackingSteps : public ::testing::Test {
 protected:
  TrackingSteps() { step(); }

  void step() {
    now_s_ += 0.001;
    const JointVector zero = JointVector::Zero(3);
    msg::JointState measured;
    write_all_joints(model_, zero, zero, Time{} + seconds(now_s_), measured);
    motion_.send("measured_js", measured);
    asked = 0;
    motion_.step(now_s_);
  }
  void give(std::uint64_t id, double x, MotionMode mode = MotionMode::tracking) {
    msg::MotionGoal message = test::goal_message(id, {x, 0, 0});
    message.mode_(static_cast<std::uint8_t>(mode));
    motion_.send("goal", message);
  }
  Histories statuses() {
    const char* const kWords[] = {"accepted", "executing", "done", "superseded", "failed"};
    Histories told;
    for (const auto& status : motion_.take<msg::MotionStatus>("status")) {
      told.push_back(std::to_string(status.goal_id_()) + " " + kWords[status.state_()]);
    }
    return told;
  }

  const RobotModel model_ = test::gantry();
  ComponentHarness motion_{with_counted_ik(), motion_with_counted_ik()};
  double now_s_ = 100;
};

TEST_F(TrackingSteps, OfEightTargetsOneIsSearchedForAndTheOthersAreSuperseded) {
  for (std::uint64_t id = 1; id <= 8; ++id) give(id, 0.1 + 0.01 * static_cast<double>(id));
  step();
  EXPECT_GT(asked, 0);
  EXPECT_LE(asked, 2 * Tracker::kMaxAttempts);
  Histories history;
  for (int id = 1; id <= 8; ++id) {
    history.push_back(std::to_string(id) + " accepted");
    history.push_back(std::to_string(id) + (id < 8 ? " superseded" : " executing"));
  }
  EXPECT_EQ(statuses(), history);
  EXPECT_TRUE(motion_.take<msg::MotionPlanRequest>("plan_request").empty());
}

TEST_F(TrackingSteps, ATargetBehindWhichOneComesThatIsNoneOrOldIsSearchedFor) {
  give(2, 0.1);
  give(3, std::numeric_limits<double>::quiet_NaN());
  give(1, 0.2);
  step();
  EXPECT_GT(asked, 0);
  EXPECT_EQ(statuses(), (Histories{"2 accepted", "2 executing", "3 failed", "1 failed"}));
}

TEST_F(TrackingSteps, WhatIsNotTrackedIsTakenInOrderBetweenTargets) {
  give(1, 0.1);
  give(2, 0.1, MotionMode::hold);
  give(3, 0.2);
  give(4, 0.3, MotionMode::planned);
  step();
  EXPECT_EQ(statuses(), (Histories{"1 accepted", "1 superseded", "2 accepted", "2 executing",
                                   "3 accepted", "2 superseded", "3 executing", "4 accepted"}));
  const auto requests = motion_.take<msg::MotionPlanRequest>("plan_request");
  ASSERT_EQ(requests.size(), 1u);
  EXPECT_EQ(requests[0].goal_id_(), 4u);
}

}  // namespace
}  // namespace armature
