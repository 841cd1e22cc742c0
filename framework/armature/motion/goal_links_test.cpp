// SPDX-License-Identifier: Apache-2.0
// A goal with forbidden zones: the bodies of the links keep away from them on the whole way.
#include <gmock/gmock.h>

#include "armature/motion/gantry_stages_test.hpp"

namespace armature {
namespace {

using test::Gantry;
using test::goal_at;
using test::rest_at;

constexpr Time kGoStart{1'000'000'000};

/// The gantry with a ball of 50 mm about its tool.
Gantry with_body() {
  Gantry gantry;
  RobotParts parts = gantry.model.parts();
  parts.capsules = {{"carriage", 2, {0, 0, 0}, {0, 0, 0}, 0.05}};
  gantry.model = parts;
  return gantry;
}

MotionGoal past_a_vessel() {
  MotionGoal goal = goal_at(1, 1, 0, 0);
  goal.forbidden = {{"vessel", {0.5, -0.1, 0}, {0.5, 0.1, 0}, 0.05}};
  return goal;
}

PlanningOptions keep(double clearance_m) { return {.min_link_clearance = clearance_m}; }

TEST(GoalLinks, ALinkThatComesTooNearIsNamedWithTheZoneAndThePlace) {
  const Gantry gantry = with_body();
  const auto plan = gantry.planner(keep(0.01)).plan(past_a_vessel(), rest_at(0, 0, 0), kGoStart);
  ASSERT_FALSE(plan);
  EXPECT_EQ(plan.error().stage, "links");
  EXPECT_THAT(
      plan.error().reason,
      testing::MatchesRegex(
          "link 'carriage' comes nearer than 10 mm \\(min_link_clearance_mm\\) to 'vessel', "
          "[0-9.]+ s after the start of the way, and no other branch of the arm leads from here "
          "to the goal: lead it to another start"));
}

TEST(GoalLinks, AWayBesideTheZoneAndARobotWithoutBodiesGo) {
  const Gantry gantry = with_body();
  MotionGoal goal = past_a_vessel();
  goal.forbidden[0].from.y() = goal.forbidden[0].to.y() = 0.111;
  EXPECT_TRUE(gantry.planner(keep(0.01)).plan(goal, rest_at(0, 0, 0), kGoStart));
  EXPECT_FALSE(gantry.planner(keep(0.012)).plan(goal, rest_at(0, 0, 0), kGoStart));
  EXPECT_TRUE(Gantry{}.planner(keep(0.01)).plan(past_a_vessel(), rest_at(0, 0, 0), kGoStart));
}

/// Nobody else keeps the tool away from a zone.
TEST(GoalLinks, AGoalWithZonesThatThePathPluginRefusesDoesNotGoStraight) {
  class KnowsNoZones final : public PathPlanner {
   public:
    Expected<Path> plan(const PathRequest& request) const override {
      if (!request.forbidden.empty()) return refuse("this path knows no zones");
      return test::LinePath{}.plan(request);
    }
  } path;
  const Gantry gantry;
  const PlanStages stages{path, gantry.ik, gantry.select, gantry.trajectory};
  GoalPlanner planner{gantry.model, stages, gantry.limits, keep(0.01)};
  const auto plan = planner.plan(past_a_vessel(), rest_at(0, 0, 0), kGoStart);
  ASSERT_FALSE(plan);
  EXPECT_EQ(plan.error().reason, "this path knows no zones");
  EXPECT_TRUE(planner.plan(goal_at(2, 1, 0, 0), rest_at(0, 0, 0), kGoStart));
}

/// A second branch, which ends beside the goal.
class TwoBranches final : public test::GantryIk {
 public:
  IkStatus solve(const IkGoal& goal, const JointVector& seed, IkBranches& out,
                 IkState& state) const override {
    const IkStatus status = GantryIk::solve(goal, seed, out, state);
    IkBranch& other = out.add();
    other = out.branch[0];
    other.label = "other";
    other.q[1] += 0.5;
    return status;
  }
};

TEST(GoalLinks, ABranchThatEndsBesideTheGoalIsNoWayOutWhereTheFirstComesTooNear) {
  const Gantry gantry = with_body();
  const TwoBranches ik;
  const PlanStages stages{gantry.path, ik, gantry.select, gantry.trajectory};
  GoalPlanner planner{gantry.model, stages, gantry.limits, keep(0.01)};
  const auto plan = planner.plan(past_a_vessel(), rest_at(0, 0, 0), kGoStart);
  ASSERT_FALSE(plan);
  EXPECT_EQ(plan.error().stage, "links");
}

/// A straight line to a place before the goal, in joint space or not, and one from there.
class Halfway final : public PathPlanner {
 public:
  PathSegment::Space first = PathSegment::Space::joint;
  bool stops = true;

  Expected<Path> plan(const PathRequest& request) const override {
    ToolPose middle = request.goal;
    middle.position.x() *= 0.5;
    PathSegment to{.space = first,
                   .samples = {{.s = 1, .pose = middle}},
                   .stop_at_end = stops,
                   .duration_s = {}};
    if (first == PathSegment::Space::cartesian) {
      to.samples.insert(to.samples.begin(), {.s = 0, .pose = request.start});
    }
    return Path{to,
                PathSegment{.space = PathSegment::Space::cartesian,
                            .samples = {{.s = 0, .pose = middle}, {.s = 1, .pose = request.goal}},
                            .stop_at_end = true,
                            .duration_s = {}}};
  }
};

/// One quintic for each segment, from rest to rest.
class RestsBehindEachSegment final : public TrajectoryPlanner {
 public:
  Expected<Trajectory> plan(const TrajectoryRequest& request) const override {
    constexpr double kDuration_s = 3;
    Trajectory trajectory{.goal_id = request.goal_id,
                          .dof = static_cast<int>(request.from.q.size()),
                          .start = request.start,
                          .knots = {0},
                          .pieces = {}};
    for (const JointSegment& segment : request.segments) {
      trajectory.knots.push_back(trajectory.knots.back() + kDuration_s);
      for (int i = 0; i < trajectory.dof; ++i) {
        trajectory.pieces.push_back(Quintic::between({segment.q.front()[i], 0, 0},
                                                     {segment.q.back()[i], 0, 0}, kDuration_s));
      }
    }
    return trajectory;
  }
};

TEST(GoalLinks, AZoneThatTheToolEntersIsEnteredOnlyInLinesBehindTheFirstJointSegments) {
  const Gantry gantry = with_body();
  Halfway path;
  const RestsBehindEachSegment trajectory;
  const PlanStages stages{path, gantry.ik, gantry.select, trajectory};
  const auto reason = [&](double zone_x) {
    GoalPlanner planner{
        gantry.model, stages, gantry.limits, {.path_only = true, .min_link_clearance = 0.01}};
    MotionGoal goal = goal_at(1, 1, 0, 0);
    goal.forbidden = {{"head", {zone_x, 0, 0}, {zone_x, 0, 0}, 0.1, true}};
    const auto plan = planner.plan(goal, rest_at(0, 0, 0), kGoStart);
    return plan ? std::string{} : plan.error().stage;
  };
  EXPECT_EQ(reason(0.9), "") << "in the second half, a line";
  EXPECT_EQ(reason(0.3), "links") << "on the joint segment";
  path.stops = false;
  EXPECT_EQ(reason(0.9), "links") << "where the joint segment ends is not told";
  path.first = PathSegment::Space::cartesian;
  EXPECT_EQ(reason(0.3), "") << "lines from the start: the path's to see";
}

/// It is where it is: on a line it must not swing away.
TEST(GoalLinks, AWayThatBeginsOnALineTakesNoOtherBranch) {
  const Gantry gantry = with_body();
  const TwoBranches ik;
  const PlanStages stages{gantry.path, ik, gantry.select, gantry.trajectory};
  GoalPlanner planner{
      gantry.model, stages, gantry.limits, {.path_only = true, .min_link_clearance = 0.01}};
  MotionGoal goal = past_a_vessel();
  goal.focus = Eigen::Vector3d{0.25, 0, 0};
  const auto plan = planner.plan(goal, rest_at(0, 0, 0), kGoStart);
  ASSERT_FALSE(plan);
  EXPECT_EQ(plan.error().stage, "links");
}

}  // namespace
}  // namespace armature
