// SPDX-License-Identifier: Apache-2.0
// An operating room without any error, for tests of the scenario.
#pragma once

#include <gtest/gtest.h>

#include <cmath>
#include <random>
#include <vector>

#include "implant.hpp"

namespace armature::task::implant {

inline const RobotModel& med7() {
  static const RobotModel model = load_robot_model(ARMATURE_SOURCE_DIR "/configs/robots/med7.yaml");
  return model;
}

inline Eigen::Isometry3d pose(double x, double y, double z, double angle,
                              const Eigen::Vector3d& axis) {
  return Eigen::Translation3d{x, y, z} * Eigen::AngleAxisd{angle, axis.normalized()};
}

inline Parameters quick(bool stop_at_sites = false) {
  return {.pivot = 0.5,
          .calibration_poses = 8,
          .min_poses = 6,
          .calibration_spread = 0.45,
          .samples_per_pose = 2,
          .jaw_samples = 5,
          .stop_at_sites = stop_at_sites,
          .auto_confirm = true};
}

/// An operating room without any error, and an arm that is where it shall go at once.
class ImplantTest : public testing::Test {
 protected:
  using Isometry3d = Eigen::Isometry3d;
  using Vector3d = Eigen::Vector3d;
  using Phase = Implant::Phase;
  using Report = GoalReport::State;

  ImplantTest() {
    chain_.base_T_tracker = pose(-1.7, 0.5, 1.2, 1.9, {0.1, 1, -0.2});
    chain_.flange_T_body = pose(0.06, -0.03, 0.08, 0.4, {0.3, 0.2, 1});
    chain_.tip = {0.01, 0.02, 0.09};
    chain_.flange_R_tool = file_tool_.linear();
    chain_.tracker_T_patient = chain_.base_T_tracker.inverse() * pose(-0.2, 0, 0.7, 2, {1, 1, 0});
    chain_.patient_T_image = pose(0.03, 0.02, -0.04, 0.3, {0, 0, 1});
    for (const double x : {0.0, 0.012}) {
      sites_.push_back(
          {{x, 0, 0.01}, Eigen::Quaterniond{Eigen::AngleAxisd{9 * x, Vector3d::UnitX()}}});
    }
  }
  void begin() {
    task_.begin(now());
    task_.see_plan(sites_);
  }
  Time now() const { return Time{} + seconds(now_s_); }
  /// 20 ms; what the arm was told before is done.
  void step() {
    now_s_ += 0.02;
    task_.see_arm(measured_flange());
    if (handpiece_) task_.see_handpiece(turn_handpiece(), now());
    if (done_) task_.hear({.goal_id = done_, .state = Report::done}, now());
    if (see_drill_) task_.see_drill_in_hand(in_hand(chain_.tip));
    if (see_driver_) task_.see_driver_in_hand(in_hand(driver_tip_));
    if (see_flange_) task_.see_flange(flange(), now());
    if (see_jaw_) {
      const Sighting sighting = jaw();
      for (int i = 0; i < times_; ++i) task_.see_jaw(sighting);
    }
    task_.update(now());
    if (const auto goal = task_.outgoing_goal(now())) drive(*goal);
  }
  Isometry3d measured_flange() {
    if (arm_noise_m_ == 0) return base_T_flange_;
    std::normal_distribution<double> normal{0, arm_noise_m_};
    return Eigen::Translation3d{normal(arm_random_), normal(arm_random_), normal(arm_random_)} *
           base_T_flange_;
  }
  Sighting in_hand(const Vector3d& tip) const {
    const double turn = 7 * now_s_;
    const Isometry3d about = pose(0.1, 0, 1.5, 0.5, {std::cos(turn), std::sin(turn), 0.3}) *
                             Eigen::Translation3d{jitter_m_ * std::sin(40 * turn), 0, 0};
    return {now(), about * Eigen::Translation3d{-tip}};
  }
  Sighting flange() {
    std::normal_distribution<double> normal{0, jitter_m_ + 1e-15};
    const Vector3d jitter{normal(random_), normal(random_), normal(random_)};
    if (frozen_) return {now(), seen_flange_};
    seen_flange_ = chain_.base_T_tracker.inverse() * base_T_flange_ * chain_.flange_T_body *
                   Eigen::Translation3d{jitter} *
                   Eigen::AngleAxisd{10 * normal(random_), Vector3d::UnitX()} *
                   Eigen::AngleAxisd{10 * normal(random_), Vector3d::UnitY()} *
                   Eigen::AngleAxisd{10 * normal(random_), Vector3d::UnitZ()};
    return {now(), seen_flange_};
  }
  Sighting jaw() {
    std::normal_distribution<double> normal{0, 1};
    const Vector3d jitter{normal(jaw_random_), normal(jaw_random_), normal(jaw_random_)};
    if (!frozen_) seen_jaw_ = chain_.tracker_T_patient * Eigen::Translation3d{jitter_m_ * jitter};
    return {now(), seen_jaw_};
  }
  void drive(const MotionGoal& goal) {
    goals_.push_back(goal);
    if (!begins_) return;
    task_.hear({.goal_id = goal.id, .state = Report::executing}, now());
    if (goal.mode == MotionMode::hold) return;
    done_ = goal.id;
    if (goal.mode != MotionMode::planned) return;
    for (const ToolPose& key : goal.through) task_.see_arm(cut_short(flange_at(key)));
    base_T_flange_ = cut_short(flange_at(goal.pose));
  }
  /// As a handpiece does that follows the arm.
  double turn_handpiece() {
    const auto& thread = task_.thread();
    if (!thread) {
      turned_from_ = angle_;
    } else {
      const Vector3d tool = (base_T_flange_ * file_tool_).translation();
      const double advance_m = std::max(thread->axis.dot(tool - thread->start), 0.0);
      angle_ = turned_from_ + turned_part_ * 2 * M_PI * advance_m / thread->pitch_m;
    }
    return angle_;
  }
  Isometry3d flange_at(const ToolPose& tool) const {
    return Eigen::Translation3d{tool.position} * std::get<Eigen::Quaterniond>(tool.orientation) *
           file_tool_.inverse();
  }
  /// Where an arm is that comes `short_m_` short of the bottoms.
  Isometry3d cut_short(const Isometry3d& base_T_flange) const {
    return base_T_flange * chain_.flange_T_tool() * Eigen::Translation3d{0, 0, -short_m_} *
           chain_.flange_T_tool().inverse();
  }
  /// Until `phase`, or for ten seconds.
  void go_to(Phase phase) {
    for (int i = 0; i < 500 && task_.phase() != phase; ++i) {
      step();
      if (task_.phase() == phase) break;
      if (task_.wants_registration()) task_.see_registration(registered(), now());
    }
    ASSERT_EQ(task_.phase(), phase) << to_string(task_.phase()) << ": " << task_.trouble();
  }
  RegisteredJaw registered() const {
    return {.jaw_T_image = chain_.patient_T_image,
            .fiducial_error_m = 0.0004,
            .sites = {{0.0003, 0.0005}, {0.0002, 0.0004}}};
  }
  void expect_tip_at(const ToolPose& tool, std::size_t site) const {
    const Vector3d tip = flange_at(tool) * chain_.flange_T_tool().translation();
    const Isometry3d image_T_site = Eigen::Translation3d{sites_[site].position} *
                                    std::get<Eigen::Quaterniond>(sites_[site].orientation);
    EXPECT_LT((tip - chain_.base_T_site(image_T_site).translation()).norm(), 1e-8);
  }
  void wait(double for_s) {
    for (double s = 0; s < for_s; s += 0.02) step();
  }

  const Isometry3d file_tool_ = pose(0, 0.02, 0.15, 0.5, {0, 1, 0});
  GuidedChain chain_;
  const Vector3d driver_tip_{0.012, 0.018, 0.085};
  std::vector<ToolPose> sites_;
  double now_s_ = 100, jitter_m_ = 0, short_m_ = 0, arm_noise_m_ = 0;
  std::mt19937 random_{5}, jaw_random_{6}, arm_random_{7};
  bool frozen_ = false;  // the tracker tells its last poses again, with new stamps
  int times_ = 1;        // that every sample of the jaw is told
  Isometry3d seen_flange_ = Isometry3d::Identity(), seen_jaw_ = Isometry3d::Identity();
  bool see_drill_ = true, see_driver_ = true, see_flange_ = true, see_jaw_ = true;
  bool handpiece_ = true;
  double angle_ = 11, turned_from_ = 11, turned_part_ = 1;
  Isometry3d base_T_flange_ = Isometry3d::Identity();
  bool begins_ = true;  // the motion, with a goal that it is sent
  std::uint64_t done_ = 0;
  std::vector<MotionGoal> goals_;
  Implant task_{quick(), med7(), file_tool_};
};

}  // namespace armature::task::implant
