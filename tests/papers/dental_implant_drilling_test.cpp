// SPDX-License-Identifier: Apache-2.0
// Zhong et al.: the LBR Med 7 goes through the key poses of a drill, planned by the plugins as they
// are deployed: path/orientations, ik/srs_arm_angle, select/nearest, trajectory/quintic_spline.
#include <gtest/gtest.h>

#include <algorithm>
#include <string>
#include <vector>

#include "armature/kinds/declared_params.hpp"
#include "armature/kinds/trajectory/time_law.hpp"
#include "armature/motion/goal_planner.hpp"
#include "armature/robot/kinematics/kinematics.hpp"
#include "armature/robot/orientations/corner_blend.hpp"
#include "armature/robot/orientations/orientation_curve.hpp"
#include "armature/robot/orientations/orientation_probe_test.hpp"
#include "armature/runtime/testing/test_plugins.hpp"

namespace armature::paper {
namespace {

using Eigen::Quaterniond;
using Eigen::Vector3d;

Params params_of(const std::string& id, const std::string& given) {
  return declared_params(std::string{ARMATURE_SOURCE_DIR "/plugins/"} + id + "/plugin.yaml",
                         "{" + given + "}");
}

/// The four stages of motion for the arm of configs/robots. An arm angle that the pose alone
/// decides
/// (`limits`): with one that keeps to the sample before, the joints lag where the path begins, and
/// the spline through few samples leaves the curve by micrometres.
class Drill : public ::testing::Test {
 protected:
  JointVector degrees(std::initializer_list<double> values) const {
    JointVector q(static_cast<Eigen::Index>(values.size()));
    std::ranges::copy(values, q.begin());
    return M_PI / 180 * q;
  }
  ToolPose pose_at(const JointVector& q) const {
    const Eigen::Isometry3d pose = forward_kinematics(model_, q);
    return {pose.translation(), Quaterniond{pose.linear()}};
  }
  /// From home through two poses to a third.
  MotionGoal goal() const {
    MotionGoal goal;
    goal.id = 1;
    goal.through = {pose_at(degrees({10, 40, 5, 70, 5, -50, 20})),
                    pose_at(degrees({-5, 50, 10, 60, -15, -70, 40}))};
    goal.pose = pose_at(degrees({15, 35, -10, 80, 10, -45, -20}));
    return goal;
  }
  Plan planned(const std::string& interpolator) {
    const auto path = built_plugins().make<PathPlanner>(
        "path/orientations", model_,
        params_of("path/orientations", "interpolator: " + interpolator));
    const PlanStages stages{**path, *ik_, *select_, *trajectory_};
    GoalPlanner planner{model_, stages, {model_.max_velocity(), model_.max_acceleration()}};
    auto plan = planner.plan(goal(), {home_, rest_, rest_}, Time{});
    EXPECT_TRUE(plan) << plan.error().stage << ": " << plan.error().reason;
    return plan ? *plan : Plan{};
  }

  const RobotModel model_ = load_robot_model(ARMATURE_SOURCE_DIR "/configs/robots/med7.yaml");
  const JointVector home_ = *model_.home(), rest_ = JointVector::Zero(7);
  PluginPtr<IkSolver> ik_ = built_plugins()
                                .make<IkSolver>("ik/srs_arm_angle", model_,
                                                params_of("ik/srs_arm_angle", "objective: limits"))
                                .value();
  PluginPtr<BranchSelector> select_ =
      built_plugins()
          .make<BranchSelector>("select/nearest", model_, params_of("select/nearest", ""))
          .value();
  PluginPtr<TrajectoryPlanner> trajectory_ =
      built_plugins()
          .make<TrajectoryPlanner>("trajectory/quintic_spline",
                                   params_of("trajectory/quintic_spline", ""))
          .value();
};

/// The curve that the path stands for, under s = 10 x^3 - 15 x^4 + 6 x^5.
TEST_F(Drill, FollowsTheCurveThroughItsKeyPosesFromRestToRest) {
  const Plan plan = planned("chart_bspline");
  ASSERT_EQ(plan.path.size(), 1u);
  std::vector<ToolPose> keys = goal().through;
  keys.insert(keys.begin(), pose_at(home_));
  keys.push_back(goal().pose);
  std::vector<double> s;
  std::vector<Vector3d> positions;
  std::vector<Quaterniond> rotations;
  for (const ToolPose& key : keys) {
    positions.push_back(key.position);
    rotations.push_back(std::get<Quaterniond>(key.orientation));
    for (const PathSample& sample : plan.path.front().samples) {
      if ((sample.pose.position - key.position).norm() < 1e-12) s.push_back(sample.s);
    }
  }
  ASSERT_EQ(s.size(), keys.size());
  const auto orientation =
      OrientationCurve::through(rotations, OrientationInterpolator::chart_bspline, s).value();
  const BlendedPolyline position{positions, s};
  const TimeLaw law{plan.trajectory.duration_s()};
  double off = 0, turned = 0;
  for (int i = 0; i <= 2000; ++i) {
    const double t = law.duration_s() * i / 2000;
    const Eigen::Isometry3d tool =
        forward_kinematics(model_, plan.trajectory.at(plan.trajectory.start + seconds(t)).q);
    off = std::max(off, (tool.translation() - position.at(law.s(t))).norm());
    turned = std::max(turned, testing::turn_between(Quaterniond{tool.linear()},
                                                    orientation.at(law.s(t)).rotation));
  }
  EXPECT_LE(off, 1e-6);
  EXPECT_LE(turned, 1e-5);
  for (const Time end : {plan.trajectory.start, plan.trajectory.end()}) {
    EXPECT_LE(plan.trajectory.at(end).v.norm(), 1e-9);
    EXPECT_LE(plan.trajectory.at(end).a.norm(), 1e-9);
  }
}

/// A jump in the angular velocity at a key: the spline through the samples takes it within a step.
TEST_F(Drill, TakesSixTimesAsLongAlongArcsThatMeetAtTheirKeysAsAlongBlends) {
  const auto duration = [&](const std::string& interpolator) {
    return planned(interpolator).trajectory.duration_s();
  };
  const double chart = duration("chart_bspline");
  EXPECT_NEAR(chart, 4.9, 0.1);
  EXPECT_NEAR(duration("slerp") / chart, 6.1, 0.1);
  EXPECT_NEAR(duration("squad") / chart, 1, 0.05);
  EXPECT_NEAR(duration("rotvec_bspline") / chart, 1, 0.05);
}

}  // namespace
}  // namespace armature::paper
