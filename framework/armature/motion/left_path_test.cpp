// SPDX-License-Identifier: Apache-2.0
// A goal that is bound to its path keeps to the lines of it, also between samples and behind a
// splice; another goal takes what serves it best.
#include "armature/motion/left_path.hpp"

#include <fmt/core.h>
#include <gmock/gmock.h>

#include <cmath>
#include <numbers>

#include "armature/motion/gantry_stages_test.hpp"
#include "armature/motion/goal_planner.hpp"

namespace armature {
namespace {

using test::Gantry;
using test::goal_at;
using test::rest_at;

constexpr Time kWayStart{1'000'000'000};

/// A pin half a metre beside the axis about which it turns.
RobotModel crank() {
  Joint joint;
  joint.name = "crank";
  joint.a = 0.5;
  joint.lower = -2;
  joint.upper = 2;
  joint.max_velocity = 1;
  joint.max_acceleration = 2.5;
  return RobotModel{{"crank",
                     RobotModel::Convention::standard,
                     {joint},
                     {{.name = "tool", .parent_joint = 0}},
                     FrameId{0},
                     Eigen::Vector3d::UnitX(),
                     std::nullopt}};
}

ToolPose pin_at(double angle) {
  const Eigen::Vector3d outward{std::cos(angle), std::sin(angle), 0};
  return {0.5 * outward, Direction{outward}};
}

class CrankIk final : public IkSolver {
 public:
  IkStatus solve(const IkGoal& goal, const JointVector&, IkBranches& out, IkState&) const override {
    out.clear();
    IkBranch& branch = out.add();
    branch.q = JointVector::Constant(1, std::atan2(goal.pose.position.y(), goal.pose.position.x()));
    branch.within_limits = true;
    return {};
  }
};

/// From the start to the goal without a sample between.
class OneStep final : public PathPlanner {
 public:
  PathSegment::Space space = PathSegment::Space::cartesian;

  Expected<Path> plan(const PathRequest& request) const override {
    return Path{{.space = space, .samples = {{0, request.start}, {1, request.goal}}}};
  }
};

TEST(GoalPlanner, RefusesALineThatTheToolLeavesBetweenItsSamples) {
  const Gantry gantry;
  const RobotModel model = crank();
  const CrankIk ik;
  const OneStep path;
  const auto reason = [&](const PlanningOptions& options) {
    const MotionLimits limits{JointVector::Constant(1, 1.0), JointVector::Constant(1, 2.5)};
    GoalPlanner planner{model, {path, ik, gantry.select, gantry.trajectory}, limits, options};
    const JointVector zero = JointVector::Zero(1);
    const auto plan = planner.plan({.id = 1, .pose = pin_at(0.2)}, {zero, zero, zero}, kWayStart);
    return plan ? "planned" : plan.error().stage + ": " + plan.error().reason;
  };
  EXPECT_EQ(reason({.path_only = true}),
            "trajectory: between samples 1 and 2 of 2 of segment 1 the tool is 2.498 mm and 0.000 "
            "degrees beside its path; 0.500 mm and 0.250 degrees are allowed there "
            "(max_path_deviation_mm, max_path_deviation_deg)");
  EXPECT_EQ(reason({.path_only = true, .max_path_deviation = {0.0026, 0.001}}), "planned");
}

TEST(GoalPlanner, TakesAWayBesideALineThatNobodyIsBoundToForNoWorseOne) {
  const Gantry gantry;
  const RobotModel model = crank();
  const CrankIk ik;
  const OneStep path;
  const MotionLimits limits{JointVector::Constant(1, 1.0), JointVector::Constant(1, 2.5)};
  GoalPlanner planner{model, {path, ik, gantry.select, gantry.trajectory}, limits};
  const JointVector zero = JointVector::Zero(1);
  const auto plan = planner.plan({.id = 1, .pose = pin_at(0.2)}, {zero, zero, zero}, kWayStart);
  ASSERT_TRUE(plan) << plan.error().reason;
  EXPECT_EQ(plan->straight_because, "");
  EXPECT_FALSE(
      planner.plan({.id = 2, .pose = pin_at(0.2), .stepwise = true}, {zero, zero, zero}, kWayStart))
      << "bound to its path";
}

/// A line in two pieces.
MotionGoal past_the_middle() {
  MotionGoal goal = goal_at(1, 1, 0, 0);
  goal.focus = Eigen::Vector3d{0.5, 0, 0};
  return goal;
}

TEST(GoalPlanner, AGoalThatIsBoundToItsPathIsNotSplicedBesideIt) {
  const Gantry gantry;
  JointState from = rest_at(0, 0, 0);
  from.v = Eigen::Vector3d{0, 0.5, 0};
  const auto begin_of = [&](const PlanningOptions& options) {
    const auto plan = gantry.planner(options).plan(past_the_middle(), from, kWayStart);
    return plan ? plan->path[0].samples[0].pose.position.y() : -1;
  };
  EXPECT_EQ(begin_of({}), 0);
  EXPECT_GT(begin_of({.path_only = true}), 0.01) << "behind a stop";
}

TEST(GoalPlanner, NamesASegmentOfAPathThatIsEmpty) {
  const Gantry gantry;
  class EmptyFirst final : public PathPlanner {
   public:
    Expected<Path> plan(const PathRequest& request) const override {
      Path path = *test::LinePath{}.plan(request);
      path.insert(path.begin(),
                  {.space = PathSegment::Space::joint, .samples = {}, .duration_s = {}});
      return path;
    }
  } path;
  GoalPlanner planner{gantry.model,
                      {path, gantry.ik, gantry.select, gantry.trajectory},
                      gantry.limits,
                      {.path_only = true}};
  const auto plan = planner.plan(past_the_middle(), rest_at(0, 0, 0), kWayStart);
  ASSERT_FALSE(plan);
  EXPECT_EQ(plan.error().reason, "segment 1 is empty");
}

/// A whole turn back from the branch of the crank.
class CrankIkOfTwoTurns final : public IkSolver {
 public:
  IkStatus solve(const IkGoal& goal, const JointVector& seed, IkBranches& out,
                 IkState& state) const override {
    const IkStatus status = CrankIk{}.solve(goal, seed, out, state);
    out.branch[0].label = "forward";
    IkBranch& back = out.add();
    back = out.branch[0];
    back.label = "back";
    back.q[0] -= 2 * std::numbers::pi;
    return status;
  }
};

class NeverForward final : public TrajectoryPlanner {
 public:
  test::OneQuintic quintic;

  Expected<Trajectory> plan(const TrajectoryRequest& request) const override {
    if (request.segments.back().q.back()[0] > 0) return refuse("never forward");
    return quintic.plan(request);
  }
};

TEST(GoalPlanner, TriesTheNextBranchWhereAWayOfTheFirstCannotBe) {
  const Gantry gantry;
  RobotParts parts = crank().parts();
  parts.joints[0].lower = -7;
  const RobotModel model{parts};
  const CrankIk one;
  const CrankIkOfTwoTurns both;
  const NeverForward trajectory;
  const MotionLimits limits{JointVector::Constant(1, 1.0), JointVector::Constant(1, 2.5)};
  const auto end = [&](const IkSolver& ik) {
    GoalPlanner planner{model, {gantry.path, ik, gantry.select, trajectory}, limits};
    const JointVector zero = JointVector::Zero(1);
    const auto plan = planner.plan({.id = 1, .pose = pin_at(0.2)}, {zero, zero, zero}, kWayStart);
    return plan ? fmt::format("{:.3f}", plan->joint_path.back().q.back()[0])
                : plan.error().stage + ": " + plan.error().reason;
  };
  EXPECT_EQ(end(both), "-6.083");
  EXPECT_EQ(end(one), "trajectory: never forward");
}

/// On an arc the tool is beside the lines between samples by what the arc bends.
TEST(LeftPath, IsNothingWhereThePathItselfBends) {
  const RobotModel model = crank();
  Plan plan{.path = {{.space = PathSegment::Space::cartesian, .samples = {}}},
            .joint_path = {{.s = {}, .q = {}}}};
  plan.trajectory = {.dof = 1, .knots = {0}, .pieces = {}};
  for (const double angle : {0.0, 0.1, 0.2}) {
    plan.path[0].samples.push_back({5 * angle, pin_at(angle)});
    plan.joint_path[0].s.push_back(5 * angle);
    plan.joint_path[0].q.push_back(JointVector::Constant(1, angle));
    if (angle == 0) continue;
    plan.trajectory.knots.push_back(10 * angle);
    plan.trajectory.pieces.push_back(Quintic::between({angle - 0.1, 0, 0}, {angle, 0, 0}, 1));
  }
  EXPECT_EQ(left_path(model, plan, {0.0005, 0.001}), std::nullopt);
  plan.path[0].samples[1].pose = {(pin_at(0).position + pin_at(0.2).position) / 2, Direction{}};
  EXPECT_NE(left_path(model, plan, {0.0005, 0.001}), std::nullopt);
  Plan stands_first = plan;
  stands_first.path.insert(stands_first.path.begin(), {.space = PathSegment::Space::joint,
                                                       .samples = {{.s = 1, .pose = pin_at(0)}},
                                                       .duration_s = {}});
  const JointVector zero = JointVector::Zero(1);
  stands_first.joint_path.insert(stands_first.joint_path.begin(),
                                 {.s = {0, 1}, .q = {zero, zero}, .duration_s = {}});
  EXPECT_NE(left_path(model, stands_first, {0.0005, 0.001}), std::nullopt);
  plan.path[0].samples[2].pose.orientation = Eigen::Quaterniond::Identity();
  EXPECT_EQ(left_path(model, plan, {0.0005, 0.001}),
            "segment 1 of the path has directions and rotations");
}

}  // namespace
}  // namespace armature
