// SPDX-License-Identifier: Apache-2.0
// A console, a leader and an instrument, for tests of the scenario.
#pragma once

#include <gtest/gtest.h>

#include "teleoperation.hpp"

namespace armature::task::teleoperation {

inline Eigen::Isometry3d pose_of(const Eigen::Vector3d& position, double angle = 0) {
  return Eigen::Translation3d{position} * Eigen::AngleAxisd{angle, Eigen::Vector3d::UnitY()};
}

class TeleoperationTest : public testing::Test {
 protected:
  using Vector3d = Eigen::Vector3d;
  using Phase = Teleoperation::Phase;
  using Report = GoalReport::State;

  /// One millisecond on.
  void see() {
    now_ = now_ + seconds(0.001);
    view_.hand_stamp = now_ - hand_is_late_;
    task_.see(view_, now_);
    if (const auto goal = task_.outgoing_leader_goal(now_)) leader_goal_ = goal;
    follower_goal_ = task_.outgoing_follower_goal();
  }
  void see(int count) {
    for (int i = 0; i < count; ++i) see();
  }
  void hear_leader(Report state, const std::string& stage = "", const std::string& reason = "") {
    task_.hear_leader(
        {.goal_id = leader_goal_->id, .state = state, .stage = stage, .reason = reason}, now_);
  }
  void show_console() {
    view_.follower_T_leader = console_;
    view_.leader_T_hand = pose_of({0, 0, 0.1});
    view_.follower_T_tool = view_.follower_T_setpoint = instrument_;
  }
  /// The leader stands on the instrument, and the motion says so.
  void align() {
    show_console();
    see();
    hear_leader(Report::executing);
    hear_leader(Report::done);
    view_.leader_T_hand = console_.inverse() * instrument_;
    see();
  }
  void give_to_hand() {
    align();
    hear_leader(Report::executing);
    view_.clutch_closed = false;
    see();
  }
  void close_clutch() {
    give_to_hand();
    view_.clutch_closed = true;
    see();
  }
  void open_and_close_clutch() {
    view_.clutch_closed = false;
    see();
    view_.clutch_closed = true;
    see();
  }
  void move_hand(double mm) { view_.leader_T_hand->translation().x() += 1e-3 * mm; }

  const Eigen::Isometry3d console_ = pose_of({0.6, -0.1, 0.1}, 0.5);
  const Eigen::Isometry3d instrument_ = pose_of({0.5, 0, 0.2}, 2);
  Teleoperation task_{{.auto_confirm = true}};
  ConsoleView view_;
  Time now_;
  Duration hand_is_late_ = seconds(0.001);
  std::optional<MotionGoal> leader_goal_, follower_goal_;
};

}  // namespace armature::task::teleoperation
