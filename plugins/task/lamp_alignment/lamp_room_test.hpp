// SPDX-License-Identifier: Apache-2.0
// A lamp, its motion and a patient, for tests of the scenario.
#pragma once

#include <gtest/gtest.h>

#include <deque>
#include <random>
#include <utility>
#include <vector>

#include "lamp_alignment.hpp"

namespace armature::task::lamp_alignment {

/// A lamp in a world where every goal takes one second, and a patient who is seen from straight
/// ahead only, at 10 Hz, with noise.
class LampAlignmentTest : public testing::Test {
 protected:
  using Phase = LampAlignment::Phase;

  void run(double duration_s) {
    const Time end = now_ + seconds(duration_s);
    while (now_ < end) tick();
  }
  bool run_until(Phase phase, double at_most_s) {
    const Time end = now_ + seconds(at_most_s);
    while (now_ < end && task_.phase() != phase) tick();
    return task_.phase() == phase;
  }

  /// In a search, from the view that shows him.
  bool looks_ahead() const {
    return task_.phase() == Phase::searching && task_.capture() &&
           std::get<Direction>(lamp_.orientation).unit.x() > 0.8;
  }

  void tick() {
    now_ = now_ + seconds(0.02);
    ++ticks_;
    for (; !late_.empty() && late_.front().first <= ticks_; late_.pop_front())
      task_.hear(late_.front().second, now_);
    if (goal_ && now_ >= arrival_) {
      lamp_ = goal_->pose;
      task_.hear({.goal_id = goal_->id, .state = GoalReport::State::done}, now_);
      goal_.reset();
    }
    if (ticks_ % 5 == 0 && task_.capture() && has_cameras_) take_picture();
    task_.step(now_);
    if (auto level = task_.take_light_level()) light_ = *level;
    if (auto goal = task_.outgoing_goal(now_)) receive(*goal);
  }

  void receive(const MotionGoal& goal) {
    goals_.push_back(goal);
    if (!answers_) return;
    if (stopped_) return drop(goal);
    if (!is_ready_) {
      task_.hear({.goal_id = goal.id,
                  .state = GoalReport::State::failed,
                  .stage = "accept",
                  .reason = "the arm is silent"},
                 now_);
      return;
    }
    if (goal.pose.position.norm() > reach_m_) {
      task_.hear({.goal_id = goal.id,
                  .state = GoalReport::State::failed,
                  .stage = "ik",
                  .reason = "out_of_reach"},
                 now_);
      return;
    }
    goal_ = goal;
    if (goal.mode != MotionMode::planned) goal_->pose = lamp_;
    arrival_ = now_ + seconds(1);
    task_.hear({.goal_id = goal.id, .state = GoalReport::State::executing}, now_);
  }

  void drop(const MotionGoal& goal) {
    const GoalReport dropped{.goal_id = goal.id,
                             .state = GoalReport::State::failed,
                             .stage = "stop",
                             .reason = "stopped until it is rearmed"};
    if (late_by_ == 0) return task_.hear(dropped, now_);
    late_.push_back({ticks_ + late_by_, dropped});
  }
  void stop() {
    stopped_ = true;
    if (goal_) drop(*goal_);
    goal_.reset();
  }
  void rearm() { stopped_ = false; }
  void expect_nothing_to_move_because_of_a_rearm(Phase phase) {
    stop();
    run(5);
    EXPECT_EQ(task_.phase(), phase);
    EXPECT_EQ(task_.trouble(), "stop: stopped until it is rearmed");
    rearm();
    const std::size_t goals = goals_.size();
    run(20);
    EXPECT_EQ(goals_.size(), goals);
    lamp_.orientation = Direction{Eigen::Vector3d::UnitX()};
  }

  void take_picture() {
    const Eigen::Vector3d looks_along = std::get<Direction>(lamp_.orientation).unit;
    const bool in_view = present_ && looks_along.x() > 0.8;
    const bool seen = in_view && !(flickers_ && ++pictures_ % 2 == 0);
    const double gray = gain_ * (100 + 200 * light_);
    task_.see(Picture{now_, seen, gray, gray}, now_);
    task_.see(Verdict{.stamp = now_,
                      .refusal = unusable_.empty() && !seen ? no_face_ : unusable_,
                      .can_be_used = unusable_.empty()});
    if (!in_view) measurements_ = 0;
    if (seen && believed_ && unusable_.empty())
      task_.see(FaceEstimate{
          .stamp = now_,
          .mouth = mouth_ + noise(noise_m_) + std::exchange(phantom_, Eigen::Vector3d::Zero()),
          .normal = (normal_ + noise(noise_rad_)).normalized(),
          .velocity = velocity_,
          .measurements = measurements_ += !predicts_});
  }
  Eigen::Vector3d noise(double sigma) {
    std::normal_distribution<double> normal{0, sigma};
    return {normal(random_), normal(random_), normal(random_)};
  }

  LampAlignment task_{Parameters{.auto_confirm = true}, 0.08};
  Time now_;
  int ticks_ = 0, late_by_ = 0;  // late_by_: a stop is told
  std::deque<std::pair<int, GoalReport>> late_;
  std::optional<MotionGoal> goal_;
  Time arrival_;
  ToolPose lamp_{.position = {0.6, 0, 0.5}, .orientation = Direction{Eigen::Vector3d::UnitY()}};
  std::vector<MotionGoal> goals_;
  bool has_cameras_ = true, present_ = true, believed_ = true, predicts_ = false, flickers_ = false,
       stopped_ = false, is_ready_ = true, answers_ = true;
  std::string unusable_;  // why no picture can be used
  std::string no_face_;   // why none is in a picture
  int measurements_ = 0, pictures_ = 0;
  double reach_m_ = 10, gain_ = 1, light_ = 0;
  double noise_m_ = 0.0005, noise_rad_ = 0.01;
  Eigen::Vector3d mouth_{1.55, 0, 0.45}, normal_{-1, 0, 0}, velocity_{0, 0, 0};
  Eigen::Vector3d phantom_{0, 0, 0};  // by which the mouth is seen elsewhere, in one picture
  std::mt19937 random_{5};
};

}  // namespace armature::task::lamp_alignment
