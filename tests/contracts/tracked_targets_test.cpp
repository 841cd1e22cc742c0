// SPDX-License-Identifier: Apache-2.0
// The motion component at 1 kHz with the solvers of its arms, and targets that go round a circle
// and are told 50 times a second. What the limits allow is followed; near a singular pose, where
// they do not, the tool keeps near, and the status says so.
#include <gtest/gtest.h>

#include <cmath>
#include <set>
#include <string>

#include "armature/kinds/joint_messages.hpp"
#include "armature/messages/armature_msgs.hpp"
#include "armature/messages/geometry.hpp"
#include "armature/messages/header.hpp"
#include "armature/messages/sensor_msgs.hpp"
#include "armature/motion/goal.hpp"
#include "armature/robot/kinematics/kinematics.hpp"
#include "armature/robot/model/robot_model.hpp"
#include "armature/runtime/testing/component_harness.hpp"
#include "armature/runtime/testing/test_plugins.hpp"

namespace armature {
namespace {

using Eigen::Vector3d;

constexpr double kRadius_m = 0.05;

/// An arm, its solver, how fast it is driven, and where it rests at first.
struct FollowingArm {
  std::string robot, ik, limits;
  std::vector<double> rest_deg = {};  // empty: at home
};

const FollowingArm kSr1{"sr1", "ik/puma_algebraic",
                        "max_velocity_rad_s: 1.65, max_acceleration_rad_s2: 6.6"};
const FollowingArm kLamp{"dental_lamp", "ik/lamp_geometric",
                         "max_velocity_rad_s: 2.5, max_acceleration_rad_s2: 8"};
const FollowingArm kMed7{"med7", "ik/srs_arm_angle",
                         "max_velocity_rad_s: 1.7, max_acceleration_rad_s2: 6.8"};

/// A motion component whose arm is where it is told to be, and a target on a circle about where the
/// tool rested, square to `axis`, with the tool's first orientation.
class CircleRun {
 public:
  CircleRun(const FollowingArm& arm, const Vector3d& axis, double hz)
      : points_{arm.robot == "dental_lamp"},
        arm_{load_robot_model(file_of(arm))},
        motion_{built_plugins(),
                {.component = "{plugin: motion, params: {" + arm.limits +
                              "}, path: {plugin: path/joint_move}, ik: {plugin: " + arm.ik +
                              "}, select: {plugin: select/nearest}, trajectory: {plugin: "
                              "trajectory/quintic}}",
                 .robot = config::load(file_of(arm))}},
        rate_{2 * M_PI * hz} {
    q_ = resting_position(arm_);
    for (std::size_t i = 0; i < arm.rest_deg.size(); ++i) {
      q_[static_cast<Eigen::Index>(i)] = arm.rest_deg[i] * M_PI / 180;
    }
    v_ = JointVector::Zero(q_.size());
    centre_ = forward_kinematics(arm_, q_);
    across_ = kRadius_m * axis.unitOrthogonal();
    along_ = axis.normalized().cross(across_);
  }

  void run(double until_s) {
    while (t_ < until_s) tick();
  }
  /// Nothing counts that was before.
  void begin_to_count() {
    squares_ = worst_m_ = fastest_ = 0;
    count_ = failures_ = 0;
    reasons_.clear();
  }

  double rms_mm() const { return 1e3 * std::sqrt(squares_ / count_); }
  double worst_mm() const { return 1e3 * worst_m_; }
  double fastest() const { return fastest_; }  // [rad/s] of all joints
  /// How the reasons in the statuses of targets begin.
  const std::set<std::string>& reasons() const { return reasons_; }
  int failures() const { return failures_; }

 private:
  static std::string file_of(const FollowingArm& arm) {
    return std::string{ARMATURE_SOURCE_DIR "/configs/robots/"} + arm.robot + ".yaml";
  }
  Vector3d target() const {
    const double u = rate_ * t_;
    return centre_.translation() + across_ * std::cos(u) + along_ * std::sin(u);
  }

  void tick() {
    t_ = 0.001 * ++ticks_;
    msg::JointState measured;
    write_all_joints(arm_, q_, v_, Time{} + seconds(t_), measured);
    motion_.send("measured_js", measured);
    if (ticks_ > 100 && ticks_ % 20 == 0) tell_target();
    motion_.step(t_);
    for (const auto& told : motion_.take<msg::JointReference>("reference")) {
      for (Eigen::Index i = 0; i < q_.size(); ++i) {
        q_[i] = told.position_()[static_cast<std::size_t>(i)];
        v_[i] = told.velocity_()[static_cast<std::size_t>(i)];
      }
    }
    for (const auto& told : motion_.take<msg::MotionStatus>("status")) {
      if (!told.reason_().empty()) reasons_.insert(told.reason_().substr(0, 19));
      failures_ += told.state_() == 4;
    }
    const double off = (forward_kinematics(arm_, q_).translation() - target()).norm();
    squares_ += off * off;
    ++count_;
    worst_m_ = std::max(worst_m_, off);
    fastest_ = std::max(fastest_, v_.cwiseAbs().maxCoeff());
  }
  void tell_target() {
    msg::MotionGoal goal;
    write_header(goal.header_(), Time{} + seconds(t_), kBaseFrame);
    goal.goal_id_(static_cast<std::uint64_t>(ticks_));
    goal.mode_(static_cast<std::uint8_t>(MotionMode::tracking));
    assign(goal.position_(), target());
    const double u = rate_ * t_;
    assign(goal.velocity_(), rate_ * (along_ * std::cos(u) - across_ * std::sin(u)));
    if (points_) {
      goal.pointing_(true);
      assign(goal.direction_(), centre_.linear() * Vector3d::UnitX());
    } else {
      assign(goal.orientation_(), Eigen::Quaterniond(centre_.linear()));
    }
    motion_.send("goal", goal);
  }

  bool points_;
  RobotModel arm_;
  ComponentHarness motion_;
  double rate_;
  JointVector q_, v_;
  Eigen::Isometry3d centre_;
  Vector3d across_, along_;
  int ticks_ = 0, count_ = 0, failures_ = 0;
  double t_ = 0, squares_ = 0, worst_m_ = 0, fastest_ = 0;
  std::set<std::string> reasons_;
};

TEST(TrackedTargets, ACircleWithinTheLimitsIsFollowedWithinAMillimetre) {
  for (const FollowingArm& arm : {kSr1, kLamp, kMed7}) {
    for (const double hz : {0.3, 0.6, 0.9}) {
      CircleRun circle{arm, {0.2, 0.3, 1}, hz};
      circle.run(3);
      circle.begin_to_count();
      circle.run(6);
      std::printf("%-12s %.1f Hz: %.3f mm rms, %.3f mm at the worst\n", arm.robot.c_str(), hz,
                  circle.rms_mm(), circle.worst_mm());
      EXPECT_LT(circle.rms_mm(), 1) << arm.robot << " at " << hz << " Hz";
      EXPECT_TRUE(circle.reasons().empty()) << *circle.reasons().begin();
    }
  }
}

TEST(TrackedTargets, NearASingularPoseTheToolKeepsNearAndTheStatusSaysWhy) {
  // Two degrees of j5 before j4 and j6 have one axis, and through that pose again and again.
  FollowingArm arm{"sr1", "ik/puma_algebraic", "", {0, -60, -30, 0, 2, 0}};
  for (const double hz : {0.2, 0.4}) {
    for (const Vector3d& axis : {Vector3d{0.2, 0.3, 1}, Vector3d{1, 0, 0.3}, Vector3d{0.3, 1, 0}}) {
      CircleRun circle{arm, axis, hz};
      circle.run(2);
      circle.begin_to_count();
      circle.run(12);
      std::printf("sr1 near its singular pose, %.1f Hz: %.1f mm rms, %.1f mm at the worst\n", hz,
                  circle.rms_mm(), circle.worst_mm());
      EXPECT_LT(circle.rms_mm(), 6);
      EXPECT_LT(circle.worst_mm(), 15);
      EXPECT_LE(circle.fastest(), 1.001);
      EXPECT_EQ(circle.failures(), 0);
      EXPECT_TRUE(circle.reasons().contains("joint j4 would need"));
    }
  }
}

}  // namespace
}  // namespace armature
