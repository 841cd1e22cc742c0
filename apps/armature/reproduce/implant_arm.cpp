// SPDX-License-Identifier: Apache-2.0
#include "reproduce/implant_arm.hpp"

#include <algorithm>
#include <stdexcept>
#include <string>

#include "armature/kinds/trajectory/time_law.hpp"
#include "armature/motion/goal_planner.hpp"
#include "armature/robot/kinematics/kinematics.hpp"
#include "armature/robot/orientations/curve_measures.hpp"
#include "reproduce/plugins.hpp"

namespace armature::reproduce {
namespace {

using Eigen::Quaterniond;
using Eigen::Vector3d;

/// The LBR Med 7 turns its tool through the keys of table 3, laid about its pose at home, by the
/// plugins as they are deployed.
class TurningArm {
 public:
  explicit TurningArm(const Keys& keys) {
    const Eigen::Isometry3d home = forward_kinematics(model_, home_);
    for (const Quaterniond& key : keys) {
      keys_.push_back(Quaterniond{home.linear()} * keys[1].conjugate() * key);
    }
    place_ = home.translation();
  }

  Trajectory planned(const std::string& interpolator) {
    const PlanStages stages{
        plugins_.get<PathPlanner>("path/orientations", "{interpolator: " + interpolator + "}",
                                  model_),
        plugins_.get<IkSolver>("ik/srs_arm_angle", "{objective: limits}", model_),
        plugins_.get<BranchSelector>("select/nearest", "", model_),
        plugins_.get<TrajectoryPlanner>("trajectory/quintic_spline", "")};
    GoalPlanner planner{model_, stages, {model_.max_velocity(), model_.max_acceleration()}};
    const JointVector rest = JointVector::Zero(model_.dof());
    MotionGoal to_first;
    to_first.id = 1;
    to_first.pose = {place_, keys_.front()};
    const Trajectory approach = plan_of(planner, to_first, {home_, rest, rest});
    MotionGoal through;
    through.id = 2;
    through.through = {{place_, keys_[1]}};
    through.pose = {place_, keys_.back()};
    return plan_of(planner, through, {approach.at(approach.end()).q, rest, rest});
  }

  /// Measures how far the tool is from the curve, in place and in turn, at 2001 instants.
  void compare(const Trajectory& plan, OrientationInterpolator kind, double& off_m,
               double& turned_rad) const {
    const OrientationCurve curve = or_throw(OrientationCurve::through(keys_, kind), "keys");
    const TimeLaw law{plan.duration_s()};
    for (int i = 0; i <= 2000; ++i) {
      const double t = law.duration_s() * i / 2000;
      const Eigen::Isometry3d tool = forward_kinematics(model_, plan.at(plan.start + seconds(t)).q);
      off_m = worst(off_m, (tool.translation() - place_).norm());
      turned_rad =
          worst(turned_rad, turn_between(Quaterniond{tool.linear()}, curve.at(law.s(t)).rotation));
    }
  }

  const RobotModel& model() const { return model_; }

 private:
  static Trajectory plan_of(GoalPlanner& planner, const MotionGoal& goal, const JointState& from) {
    const auto plan = planner.plan(goal, from, Time{});
    if (!plan)
      throw std::runtime_error(std::string{plan.error().stage} + ": " + plan.error().reason);
    return plan->trajectory;
  }

  RobotModel model_ = shipped_robot("med7");
  JointVector home_ = *model_.home();
  Plugins plugins_;
  Keys keys_;
  Vector3d place_;
};

}  // namespace

void add_turning_arm(const Keys& keys, Results& results) {
  TurningArm arm{keys};
  const Trajectory plan = arm.planned("chart_bspline");
  double off_m = 0, turned_rad = 0;
  arm.compare(plan, OrientationInterpolator::chart_bspline, off_m, turned_rad);
  results.value("robot", "tool off its place", 1e3 * off_m);
  results.value("robot", "turn off the curve", turned_rad);
  results.value("robot", "speed at the ends",
                std::max(plan.at(plan.start).v.norm(), plan.at(plan.end()).v.norm()));
  results.value("robot", "slerp's time of chart_bspline's",
                arm.planned("slerp").duration_s() / plan.duration_s());
  constexpr int kSamples = 300;
  std::vector<double> time;
  std::vector<std::vector<double>> q(7), v(7);
  for (int i = 0; i <= kSamples; ++i) {
    time.push_back(plan.duration_s() * i / kSamples);
    const JointState state = plan.at(plan.start + seconds(time.back()));
    for (std::size_t j = 0; j < 7; ++j) {
      q[j].push_back(state.q[static_cast<Eigen::Index>(j)]);
      v[j].push_back(state.v[static_cast<Eigen::Index>(j)]);
    }
  }
  for (std::size_t j = 0; j < 7; ++j) {
    results.curve("robot_joints", 0, arm.model().joints()[j].name, time, q[j]);
    results.curve("robot_joints", 1, arm.model().joints()[j].name, time, v[j]);
  }
}

}  // namespace armature::reproduce
