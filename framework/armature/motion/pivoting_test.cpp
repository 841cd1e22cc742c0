// SPDX-License-Identifier: Apache-2.0
// A shaft that pivots about an incision, at every millisecond of what the arm does: 1. it stays in
// the incision, and the arm within its limits, whatever the target does, 2. the tip comes to its
// target, 3. it waits before a target that cannot be met and comes when it can, 4. it stops about
// the incision, 5. what cannot be pivoted about is told.
#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "armature/motion/newton_ik_test.hpp"
#include "armature/motion/tracking.hpp"
#include "armature/robot/geometry/rotation_vector.hpp"
#include "armature/robot/kinematics/kinematics.hpp"

namespace armature {
namespace {

using Eigen::Isometry3d;
using Eigen::Vector3d;

constexpr double kPeriod_s = 0.001;
constexpr PivotOptions kPivot{.max_deviation = 1e-4, .max_offset = 1e-3, .min_depth = 0.01};

/// An arm with a shaft, whatever its file says, and home within the middle of its limits.
RobotModel with_shaft(const char* file) {
  const RobotModel arm =
      load_robot_model(std::string{ARMATURE_SOURCE_DIR "/configs/robots/"} + file);
  JointVector home = arm.home().value();
  for (int i = 0; i < arm.dof(); ++i) {
    const double room = 0.3 * (arm.upper()[i] - arm.lower()[i]);
    home[i] = std::clamp(home[i], arm.lower()[i] + room, arm.upper()[i] - room);
  }
  return {{arm.name(), arm.convention(), arm.joints(), arm.frames(), arm.tool(), std::nullopt, home,
           Shaft{.axis = Vector3d{0, 0, 1}, .length = 0.28}}};
}

/// An arm whose shaft is in an incision, step by step as motion drives it. Every step asserts that
/// the shaft is in the incision and the arm within its limits.
class PivotingArm {
 public:
  PivotingArm(const RobotModel& model, const JointVector& q, double depth,
              const TrackingOptions& options)
      : model_{model},
        ik_{model},
        limits_{model.max_velocity(), model.max_acceleration()},
        options_{options},
        tracker_{model, limits_, ik_, options},
        way_{short_hold_at(q, Time{}, 0)} {
    const Isometry3d pose = forward_kinematics(model, q);
    centre_ = {.point = pose * Vector3d{-depth * model.shaft()->axis}, .shaft = *model.shaft()};
    tracker_.pivot()->set_incision(centre_.point);
  }

  /// One millisecond towards `goal`, as GoalExecution does it.
  TrackingFailure step(const MotionGoal& goal) {
    const Time start = now_ + seconds(kPeriod_s);
    const JointState from = way_.view().at(start);
    const bool under_way = tracked_ && !at_rest(from);
    const TrackingFailure failure = under_way ? tracker_.follow(goal, from, start, next_)
                                              : tracker_.begin(goal, from, start, next_);
    tracked_ = true;
    if (failure.stage.empty()) pending_ = next_;
    go_on();
    return failure;
  }
  bool stop() {
    const bool made = tracker_.stop(state(), now_, 1, next_);
    if (made) way_ = next_;
    return made;
  }
  /// One millisecond without a goal.
  void go_on() {
    now_ = now_ + seconds(kPeriod_s);
    if (pending_) way_ = *std::exchange(pending_, std::nullopt);
    judge();
  }

  JointState state() const { return way_.view().at(now_); }
  Isometry3d pose() const { return forward_kinematics(model_, state().q); }
  double depth() const { return centre_.depth(pose()); }
  const RemoteCentre& centre() const { return centre_; }
  double time_s() const { return to_seconds(now_ - Time{}); }
  Tracker& tracker() { return tracker_; }
  double max_speed() const { return max_speed_; }

 private:
  void judge() {
    const JointState is = state();
    EXPECT_LE(centre_.deviation(pose()), kPivot.max_deviation + 1e-9) << time_s();
    EXPECT_TRUE(model_.within_limits(is.q, 1e-6)) << time_s();
    EXPECT_LE(is.v.cwiseQuotient(limits_.max_velocity).cwiseAbs().maxCoeff(), 1.001) << time_s();
    EXPECT_LE(is.a.cwiseQuotient(limits_.max_acceleration).cwiseAbs().maxCoeff(), 1.002)
        << time_s();
    if (before_) {
      const double moved = (pose().translation() - before_->translation()).norm();
      max_speed_ = std::max(max_speed_, moved / kPeriod_s);
    }
    before_ = pose();
  }

  const RobotModel& model_;
  test::NewtonIk ik_;
  MotionLimits limits_;
  TrackingOptions options_;
  Tracker tracker_;
  RemoteCentre centre_;
  ShortTrajectory way_, next_;
  std::optional<ShortTrajectory> pending_;
  Time now_;
  bool tracked_ = false;
  std::optional<Isometry3d> before_;
  double max_speed_ = 0;
};

/// What the tip shall do: along ellipses of any place and size about where it is, and roll.
class AnyTarget {
 public:
  AnyTarget(const Isometry3d& start, double size_m, double hz, std::mt19937_64& random)
      : start_{start}, omega_{2 * M_PI * hz} {
    std::uniform_real_distribution<double> any{-1, 1};
    for (Vector3d* axis : {&cosine_, &sine_}) {
      *axis = size_m * Vector3d{any(random), any(random), any(random)};
    }
    roll_ = any(random);
  }
  MotionGoal at(double t) const {
    const double u = omega_ * t;
    MotionGoal goal{.id = 1, .mode = MotionMode::tracking, .pose = {}};
    goal.pose.position = start_.translation() + cosine_ * (1 - std::cos(u)) + sine_ * std::sin(u);
    goal.pose.orientation = Eigen::Quaterniond{
        start_.linear() * Eigen::AngleAxisd{roll_ * std::sin(u), Vector3d::UnitZ()}};
    goal.velocity = omega_ * (cosine_ * std::sin(u) + sine_ * std::cos(u));
    goal.angular_velocity = start_.linear() * Vector3d{0, 0, roll_ * omega_ * std::cos(u)};
    return goal;
  }

 private:
  Isometry3d start_;
  Vector3d cosine_, sine_;
  double roll_, omega_;
};

/// Within the middle of every joint's range, away from singular poses of the wrist and the elbow.
JointVector any_pose(const RobotModel& model, std::mt19937_64& random) {
  std::uniform_real_distribution<double> part{-0.25, 0.25};
  JointVector q = resting_position(model);
  for (int i = 0; i < model.dof(); ++i) q[i] += part(random);
  return q;
}

class Pivoting : public testing::TestWithParam<const char*> {
 protected:
  const RobotModel arm_ = with_shaft(GetParam());
  const TrackingOptions options_{
      .shortest_horizon_s = 0.01, .max_tool_speed = 0.05, .pivot = kPivot};
};

INSTANTIATE_TEST_SUITE_P(Arms, Pivoting, testing::Values("med7_scope.yaml", "sr1.yaml"),
                         [](const auto& of) {
                           const std::string file = of.param;
                           return file.substr(0, file.find('.'));
                         });

TEST_P(Pivoting, StaysInTheIncisionWhateverTheTargetDoes) {
  const auto seed = 11;
  std::mt19937_64 random{seed};
  std::uniform_real_distribution<double> depth{0.02, 0.25}, size{0.002, 0.2}, hz{0.05, 2};
  for (int run = 0; run < 10; ++run) {
    SCOPED_TRACE(testing::Message() << "seed " << seed << ", run " << run);
    PivotingArm arm{arm_, any_pose(arm_, random), depth(random), options_};
    const AnyTarget target{arm.pose(), size(random), hz(random), random};
    for (int k = 0; k < 1500; ++k) {
      const TrackingFailure failure = arm.step(target.at(arm.time_s()));
      ASSERT_NE(failure.stage, "ik") << failure.reason.view();
      ASSERT_FALSE(HasFailure());
    }
    EXPECT_LE(arm.max_speed(), 0.05 * 1.001);
  }
}

TEST_P(Pivoting, TheTipKeepsToATargetThatTheArmCanFollow) {
  const auto seed = 12;
  std::mt19937_64 random{seed};
  std::uniform_real_distribution<double> depth{0.08, 0.2};
  for (int run = 0; run < 8; ++run) {
    SCOPED_TRACE(testing::Message() << "seed " << seed << ", run " << run);
    PivotingArm arm{arm_, any_pose(arm_, random), depth(random), options_};
    const AnyTarget target{arm.pose(), 0.01, 0.2, random};
    double tip_off = 0, shaft_off = 0;
    for (int k = 0; k < 1500; ++k) {
      const MotionGoal goal = target.at(arm.time_s());
      arm.step(goal);
      if (k < 1000) continue;  // it begins with a jump of the target in speed
      const Isometry3d pose = arm.pose();
      tip_off = std::max(tip_off, (pose.translation() - goal.pose.position).norm());
      shaft_off = std::max(shaft_off, arm.centre().deviation(pose));
    }
    EXPECT_LT(tip_off, 1e-6);
    EXPECT_LT(shaft_off, 1e-6) << "the way between two targets is on the incision, too";
  }
}

TEST_P(Pivoting, ComesToATargetFarAwayAndRollsTheShaftAsItSays) {
  PivotingArm arm{arm_, resting_position(arm_), 0.1, options_};
  const Isometry3d start = arm.pose();
  MotionGoal goal{.id = 1, .mode = MotionMode::tracking, .pose = {}};
  goal.pose.position = start * Vector3d{0.02, 0.015, 0.01};
  goal.pose.orientation =
      Eigen::Quaterniond{start.linear() * Eigen::AngleAxisd{0.3, Vector3d::UnitZ()}};
  for (int k = 0; k < 3000; ++k) arm.step(goal);
  EXPECT_LT((arm.pose().translation() - goal.pose.position).norm(), 1e-6);
  const Isometry3d wanted =
      arm.centre().pivoted(Eigen::Translation3d{goal.pose.position} *
                           std::get<Eigen::Quaterniond>(goal.pose.orientation));
  EXPECT_TRUE(arm.pose().isApprox(wanted, 1e-6));
  EXPECT_GT(arm.max_speed(), 0.025) << "it need not be slower";
}

TEST_P(Pivoting, WaitsAtTheLeastDepthForATipThatShallGoThroughTheIncision) {
  PivotingArm arm{arm_, resting_position(arm_), 0.05, options_};
  const Isometry3d start = arm.pose();
  MotionGoal goal{.id = 1, .mode = MotionMode::tracking, .pose = {}};
  goal.pose.orientation = Eigen::Quaterniond{start.linear()};
  for (int k = 0; k < 4000; ++k) {
    goal.pose.position = start * Vector3d{0, 0.001, -std::min(0.06, 3e-5 * k)};
    const TrackingFailure failure = arm.step(goal);
    ASSERT_NE(failure.stage, "ik");
    ASSERT_GE(arm.depth(), kPivot.min_depth - 1e-6) << k;
  }
  EXPECT_LT(arm.depth(), kPivot.min_depth + 2e-3) << "it goes as far as it may";
  EXPECT_FALSE(arm.tracker().waits_for().empty());
  EXPECT_TRUE(at_rest(arm.state()));
  goal.pose.position = start.translation();
  for (int k = 0; k < 3000; ++k) arm.step(goal);
  EXPECT_NEAR(arm.depth(), 0.05, 1e-6) << "it comes back with the target";
}

TEST_P(Pivoting, StopsAboutTheIncisionInTheTimeThatTheLimitsAsk) {
  const auto seed = 13;
  std::mt19937_64 random{seed};
  std::uniform_real_distribution<double> depth{0.03, 0.2};
  for (int run = 0; run < 12; ++run) {
    SCOPED_TRACE(testing::Message() << "seed " << seed << ", run " << run);
    PivotingArm arm{arm_, any_pose(arm_, random), depth(random), options_};
    const AnyTarget target{arm.pose(), 0.05, 0.5, random};
    for (int k = 0; k < 400 + 10 * run; ++k) arm.step(target.at(arm.time_s()));
    const double use = arm.state().v.cwiseQuotient(arm_.max_acceleration()).cwiseAbs().maxCoeff();
    ASSERT_TRUE(arm.stop());
    int stops = 0;
    while (!at_rest(arm.state()) && stops < 1000) arm.go_on(), ++stops;
    EXPECT_LT(stops * kPeriod_s, 0.02 + 4 * use);
  }
}

TEST_P(Pivoting, AShaftThatIsALittleBesideComesBackAndGoesNoFurther) {
  PivotingArm arm{arm_, resting_position(arm_), 0.1, options_};
  const Vector3d beside = arm.pose().linear() * Vector3d{0.0005, 0, 0};
  RemoteCentre centre = arm.centre();
  centre.point += beside;
  arm.tracker().pivot()->set_incision(centre.point);
  EXPECT_TRUE(arm.tracker().pivot()->refusal(arm.state().q).empty());
  MotionGoal goal{.id = 1, .mode = MotionMode::tracking, .pose = {}};
  goal.pose = {arm.pose().translation(), Eigen::Quaterniond{arm.pose().linear()}};
  double before = centre.deviation(arm.pose());
  ShortTrajectory way;
  const TrackingFailure failure = arm.tracker().begin(goal, arm.state(), Time{}, way);
  ASSERT_TRUE(failure.stage.empty()) << failure.reason.view();
  for (double t = 0; t < way.view().duration_s(); t += 1e-3) {
    const double off =
        centre.deviation(forward_kinematics(arm_, way.view().at(Time{} + seconds(t)).q));
    EXPECT_LE(off, before + 1e-9);
    before = off;
  }
  EXPECT_LT(before, 1e-5);
}

TEST_P(Pivoting, AnIncisionThatTheShaftIsNotInIsToldWithItsPlaceAndTheWayOut) {
  PivotingArm arm{arm_, resting_position(arm_), 0.1, options_};
  Pivot& pivot = *arm.tracker().pivot();
  const auto refusal_at = [&](const Vector3d& in_tool) {
    pivot.set_incision(arm.pose() * in_tool);
    return std::string{pivot.refusal(arm.state().q).view()};
  };
  EXPECT_EQ(refusal_at({0, 0, -0.1}), "");
  const std::string beside = refusal_at({0.016, 0, -0.1});
  EXPECT_NE(beside.find("the shaft passes the incision at ("), std::string::npos) << beside;
  EXPECT_NE(beside.find("m by 16.00 mm, more than max_incision_offset_mm, 1: register the incision "
                        "where the shaft is, or bring the shaft through it"),
            std::string::npos)
      << beside;
  const std::string behind = refusal_at({0, 0, -0.3});
  EXPECT_NE(behind.find("lies 300.0 mm behind the tip, not on the 280.0 mm of the shaft"),
            std::string::npos)
      << behind;
  EXPECT_NE(refusal_at({0, 0, 0.02}).find("lies -20.0 mm behind the tip"), std::string::npos);
}

}  // namespace
}  // namespace armature
