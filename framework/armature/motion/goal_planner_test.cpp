// SPDX-License-Identifier: Apache-2.0
#include "armature/motion/goal_planner.hpp"

#include <gmock/gmock.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "armature/motion/gantry_stages_test.hpp"

namespace armature {
namespace {

using test::Gantry;
using test::goal_at;
using test::rest_at;

constexpr Time kStart{1'000'000'000};

TEST(GoalPlanner, EndsAtRestAtTheGoal) {
  const Gantry gantry;
  auto plan = gantry.planner().plan(goal_at(4, 0.5, 0.6, 0.7), rest_at(0, 0, 0), kStart);
  ASSERT_TRUE(plan) << plan.error().reason;
  const JointState end = plan->trajectory.at(plan->trajectory.end());
  EXPECT_NEAR((end.q - Eigen::Vector3d(0.7, 0.6, 0.5)).norm(), 0, 1e-9);
  EXPECT_NEAR(end.v.norm(), 0, 1e-9);
  EXPECT_EQ(plan->trajectory.goal_id, 4u);
  EXPECT_EQ(plan->trajectory.start, kStart);
}

TEST(GoalPlanner, LeavesAMovingReferenceWithItsPositionVelocityAndAcceleration) {
  const Gantry gantry;
  JointState from = rest_at(0.1, 0.2, 0.3);
  from.v = Eigen::Vector3d{0.4, -0.3, 0.1};
  from.a = Eigen::Vector3d{-1, 1, 0.5};
  auto plan = gantry.planner().plan(goal_at(1, 0.5, 0.6, 0.7), from, kStart);
  ASSERT_TRUE(plan) << plan.error().reason;
  const JointState start = plan->trajectory.at(kStart);
  EXPECT_NEAR((start.q - from.q).norm(), 0, 1e-12);
  EXPECT_NEAR((start.v - from.v).norm(), 0, 1e-12);
  EXPECT_NEAR((start.a - from.a).norm(), 0, 1e-12);
}

TEST(GoalPlanner, SolvesEverySampleOfTheWholePath) {
  const Gantry gantry;
  MotionGoal goal = goal_at(1, 1, 0, 0);
  goal.focus = Eigen::Vector3d{0.5, 0.5, 0};
  auto plan = gantry.planner().plan(goal, rest_at(0, 0, 0), kStart);
  ASSERT_TRUE(plan) << plan.error().reason;
  ASSERT_EQ(plan->joint_path.size(), 1u);
  const JointSegment& segment = plan->joint_path[0];
  EXPECT_EQ(segment.s, (std::vector<double>{0, 0.5, 1}));
  EXPECT_EQ(segment.q[0], (Eigen::Vector3d{0, 0, 0}));
  EXPECT_EQ(segment.q[1], (Eigen::Vector3d{0, 0.5, 0.5}));
  EXPECT_EQ(segment.q[2], (Eigen::Vector3d{0, 0, 1}));
}

TEST(GoalPlanner, GoesThroughTheKeyPosesOfAGoal) {
  const Gantry gantry;
  MotionGoal goal = goal_at(1, 1, 0, 0);
  goal.through = {goal_at(0, 0.25, 0.5, 0).pose, goal_at(0, 0.75, 0, 0.5).pose};
  auto plan = gantry.planner().plan(goal, rest_at(0, 0, 0), kStart);
  ASSERT_TRUE(plan) << plan.error().reason;
  ASSERT_EQ(plan->joint_path.size(), 1u);
  const JointSegment& segment = plan->joint_path[0];
  ASSERT_EQ(segment.q.size(), 4u);
  EXPECT_EQ(segment.q[1], (Eigen::Vector3d{0, 0.5, 0.25}));
  EXPECT_EQ(segment.q[2], (Eigen::Vector3d{0.5, 0, 0.75}));
}

TEST(GoalPlanner, NeverGoesStraightPastKeyPoses) {
  Gantry gantry;
  MotionGoal goal = goal_at(1, 1.75, 0, 0);  // which the path refuses
  EXPECT_TRUE(gantry.planner().plan(goal, rest_at(0, 0, 0), kStart));
  goal.through = {goal_at(0, 0.5, 0.5, 0).pose};
  auto plan = gantry.planner().plan(goal, rest_at(0, 0, 0), kStart);
  ASSERT_FALSE(plan);
  EXPECT_EQ(plan.error().stage, "path");
  EXPECT_EQ(plan.error().reason, "x beyond 1.5 m");
}

/// A splice leaves the path for as long as the old motion fades out.
TEST(GoalPlanner, StopsBeforeItGoesThroughKeyPoses) {
  Gantry gantry;
  JointState from = rest_at(0, 0, 0);
  from.v = Eigen::Vector3d{0.5, 0, 0};
  MotionGoal goal = goal_at(1, 1, 0, 0);
  ASSERT_TRUE(gantry.planner().plan(goal, from, kStart));
  EXPECT_NE(gantry.trajectory.last_request.from.v.norm(), 0);
  goal.through = {goal_at(0, 0.5, 0.5, 0).pose};
  auto plan = gantry.planner().plan(goal, from, kStart);
  ASSERT_TRUE(plan) << plan.error().reason;
  EXPECT_EQ(gantry.trajectory.last_request.from.v.norm(), 0);
  EXPECT_NEAR(plan->trajectory.at(kStart).v[0], 0.5, 1e-12);
  EXPECT_NEAR(plan->trajectory.at(plan->trajectory.end()).q[2], 1, 1e-9);
}

/// The gantry's joints are the tool's coordinates.
double peak_speed_of(const Trajectory& trajectory) {
  double peak = 0;
  for (double t = 0; t <= trajectory.duration_s(); t += 1e-3) {
    peak = std::max(peak, state_at(trajectory.view(), t).v.norm());
  }
  return peak;
}

TEST(GoalPlanner, IsNowhereFasterThanItsGoalAllowsAndNotMuchSlower) {
  const Gantry gantry;
  MotionGoal goal = goal_at(1, 0.5, 0.6, 0.7);
  const auto free = gantry.planner().plan(goal, rest_at(0, 0, 0), kStart);
  goal.max_speed = 0.01;
  const auto slow = gantry.planner().plan(goal, rest_at(0, 0, 0), kStart);
  ASSERT_TRUE(free && slow);
  EXPECT_GT(peak_speed_of(free->trajectory), 0.5);
  EXPECT_LE(peak_speed_of(slow->trajectory), 0.01);
  EXPECT_GE(peak_speed_of(slow->trajectory), 0.0099);
  goal.max_speed = 100;
  const auto fast = gantry.planner().plan(goal, rest_at(0, 0, 0), kStart);
  ASSERT_TRUE(fast);
  EXPECT_EQ(fast->trajectory.duration_s(), free->trajectory.duration_s());
}

TEST(GoalPlanner, StopsBeforeItGoesSlowly) {
  Gantry gantry;
  JointState from = rest_at(0, 0, 0);
  from.v = Eigen::Vector3d{0.5, 0, 0};
  MotionGoal goal = goal_at(1, 1, 0, 0);
  goal.max_speed = 0.02;
  auto plan = gantry.planner().plan(goal, from, kStart);
  ASSERT_TRUE(plan) << plan.error().reason;
  EXPECT_EQ(gantry.trajectory.last_request.from.v.norm(), 0);
  EXPECT_NEAR(plan->trajectory.at(kStart).v[0], 0.5, 1e-12);
}

TEST(GoalPlanner, TellsTheSolverTheRedundancyOfTheJointsThatItTookBefore) {
  const Gantry gantry;
  MotionGoal goal = goal_at(1, 1, 0, 0);
  goal.focus = Eigen::Vector3d{0.5, 0.5, 0};
  auto plan = gantry.planner().plan(goal, rest_at(0.1, 0.2, 0.3), kStart);
  ASSERT_TRUE(plan) << plan.error().reason;
  // The goal by itself and the first sample from the start, the next from the first.
  const double start = 0.1 + 0.2 + 0.3, first = plan->joint_path[0].q[1].sum();
  ASSERT_EQ(gantry.ik.told.size(), 3u);
  EXPECT_EQ(gantry.ik.told[0], start);
  EXPECT_EQ(gantry.ik.told[1], start);
  EXPECT_EQ(gantry.ik.told[2], first);
}

TEST(GoalPlanner, SaysByHowMuchAGoalIsOutOfReach) {
  const Gantry gantry;
  auto plan = gantry.planner().plan(goal_at(1, 2.25, 0, 0), rest_at(0, 0, 0), kStart);
  ASSERT_FALSE(plan);
  EXPECT_EQ(plan.error().stage, "ik");
  EXPECT_THAT(plan.error().reason, testing::StartsWith("the goal: out_of_reach: 0.25"));
}

TEST(GoalPlanner, GoesStraightInJointSpaceWhenThePathRefuses) {
  const Gantry gantry;
  auto plan = gantry.planner().plan(goal_at(1, 1.75, 0, 0), rest_at(0, 0, 0), kStart);
  ASSERT_TRUE(plan) << plan.error().reason;
  EXPECT_EQ(plan->path.front().space, PathSegment::Space::joint);
}

TEST(GoalPlanner, GoesNowhereElseWhenOnlyThePathWillDo) {
  Gantry gantry;
  const auto refused =
      gantry.planner({.path_only = true}).plan(goal_at(1, 1.75, 0, 0), rest_at(0, 0, 0), kStart);
  ASSERT_FALSE(refused);
  EXPECT_EQ(refused.error().stage, "path");
  EXPECT_EQ(refused.error().reason, "x beyond 1.5 m");
  gantry.path.throws = true;
  EXPECT_FALSE(
      gantry.planner({.path_only = true}).plan(goal_at(1, 1, 0, 0), rest_at(0, 0, 0), kStart));
  JointState moving = rest_at(0, 0, 0);
  moving.v = Eigen::Vector3d{0.2, 0, 0};
  EXPECT_FALSE(gantry.planner({.path_only = true}).plan(goal_at(1, 1, 0, 0), moving, kStart));
}

TEST(GoalPlanner, TellsThatTheSolversLimitsAreNarrowerWhenLimitsAreWhyAPoseIsNotReached) {
  Gantry gantry;
  const auto reason = [&](bool narrow) {
    return gantry.planner({.narrow_solver = narrow})
        .plan(goal_at(1, 0, 2.25, 0), rest_at(0, 0, 0), kStart)
        .error()
        .reason;
  };
  EXPECT_EQ(reason(true), reason(false)) << "no limit would bring it there";
  gantry.ik.beyond = IkStatus::Code::joint_limit;
  EXPECT_EQ(reason(true), reason(false) + "; limit_margin_deg or _mm narrows its limits");
}

TEST(GoalPlanner, HandsForbiddenZonesToThePath) {
  const Gantry gantry;
  MotionGoal goal = goal_at(1, 1, 0, 0);
  goal.forbidden = {{"artery", {1, 2, 3}, {4, 5, 6}, 0.01}};
  ASSERT_TRUE(gantry.planner().plan(goal, rest_at(0, 0, 0), kStart));
  ASSERT_EQ(gantry.path.last_request.forbidden.size(), 1u);
  EXPECT_EQ(gantry.path.last_request.forbidden[0].name, "artery");
}

/// A path that states a needle's depth, and a solver that keeps the last one it was asked for.
class DeepPath final : public PathPlanner {
 public:
  Expected<Path> plan(const PathRequest& request) const override {
    return Path{{.space = PathSegment::Space::joint,
                 .samples = {{1, request.goal, Redundancy{0.25, true}}}}};
  }
};
class AlwaysHome final : public IkSolver {
 public:
  mutable std::optional<double> asked;
  bool slides = true;

  bool redundancy_is_length() const override { return slides; }
  IkStatus solve(const IkGoal& goal, const JointVector& seed, IkBranches& out,
                 IkState&) const override {
    asked = goal.redundancy;
    out.clear();
    IkBranch& branch = out.add();
    branch.q = seed;
    branch.within_limits = true;
    return {};
  }
};

TEST(GoalPlanner, AsksForANeedlesDepthOnlyWhereTheArmHasAFreedomMoreThanThePoseTakes) {
  const auto planned = [](const RobotModel& model, const Orientation& orientation, AlwaysHome& ik) {
    const Gantry stages;
    const DeepPath path;
    GoalPlanner planner{model,
                        {path, ik, stages.select, stages.trajectory},
                        {model.max_velocity(), model.max_acceleration()},
                        {.path_only = true}};
    MotionGoal goal = goal_at(1, 1, 0, 0);
    goal.pose.orientation = orientation;
    const JointVector zero = JointVector::Zero(model.dof());
    return planner.plan(goal, {resting_position(model), zero, zero}, kStart);
  };
  const auto asked = [&](const RobotModel& model, const Orientation& orientation) {
    AlwaysHome ik;
    static_cast<void>(planned(model, orientation, ik));
    return ik.asked;
  };
  const Orientation direction = Direction{Eigen::Vector3d::UnitX()};
  const Orientation rotation = Eigen::Quaterniond::Identity();
  const auto robot = [](const char* file) {
    return load_robot_model(std::string{ARMATURE_SOURCE_DIR "/configs/robots/"} + file);
  };
  EXPECT_EQ(asked(test::gantry(), direction), std::nullopt);
  EXPECT_EQ(asked(robot("sr1_needle.yaml"), direction), 0.25);
  EXPECT_EQ(asked(robot("sr1.yaml"), rotation), std::nullopt);

  AlwaysHome turning;  // a solver of arm angles
  turning.slides = false;
  const auto refused = planned(robot("med7.yaml"), rotation, turning);
  ASSERT_FALSE(refused);
  EXPECT_EQ(refused.error().reason,
            "the path states a length, such as a needle's depth, and the solver holds none");
}

/// A detour by joint positions of its own, which take the tool to `there`.
class JointsPath final : public PathPlanner {
 public:
  JointVector detour;
  ToolPose there;
  PathSegment::Space space = PathSegment::Space::joint;
  mutable std::optional<JointVector> started_at;

  Expected<Path> plan(const PathRequest& request) const override {
    started_at = request.start_joints;
    const PathSample by_joints{.s = 1, .pose = there, .redundancy = {}, .joints = detour};
    return Path{{.space = space, .samples = {by_joints}},
                {.space = PathSegment::Space::joint, .samples = {{1, request.goal}}}};
  }
};

TEST(GoalPlanner, GoesThroughTheJointsThatAPathNamesWithoutSolvingForThem) {
  const Gantry gantry;
  JointsPath path;
  GoalPlanner planner{
      gantry.model, {path, gantry.ik, gantry.select, gantry.trajectory}, gantry.limits, {}};
  path.detour = Eigen::Vector3d{0.1, 0.2, 0.3};
  path.there = goal_at(0, 0.3, 0.2, 0.1).pose;
  const auto plan = planner.plan(goal_at(1, 0.5, 0, 0), rest_at(0, 0, 0.1), kStart);
  ASSERT_TRUE(plan) << plan.error().reason;
  ASSERT_EQ(plan->joint_path.size(), 2u);
  EXPECT_EQ(plan->joint_path[0].q.back(), path.detour);
  EXPECT_EQ(*path.started_at, (Eigen::Vector3d{0, 0, 0.1}));
}

TEST(GoalPlanner, SaysWhatIsWrongWithTheJointsThatAPathNames) {
  const Gantry gantry;
  JointsPath path;
  GoalPlanner planner{gantry.model,
                      {path, gantry.ik, gantry.select, gantry.trajectory},
                      gantry.limits,
                      {.path_only = true}};
  const auto reason = [&](JointVector joints) {
    path.detour = std::move(joints);
    return planner.plan(goal_at(1, 0.5, 0, 0), rest_at(0, 0, 0), kStart).error().reason;
  };
  const std::string where = "sample 1 of 1 of segment 1: ";
  EXPECT_EQ(reason(JointVector::Zero(2)), where + "2 joints, and the robot has 3");
  EXPECT_EQ(reason(JointVector::Constant(3, NAN)), where + "its joints are not finite");
  EXPECT_EQ(reason(JointVector::Constant(3, 1e3)), where + "its joints are beyond their limits");
  path.there = goal_at(0, 0.05, 0, 0).pose;
  EXPECT_EQ(reason(JointVector::Zero(3)),
            where + "its joints take the tool past its pose by 50.0000 mm and 0.0000 degrees");
  path.there = {.position = {0, 0, 0}, .orientation = Direction{Eigen::Vector3d::UnitY()}};
  EXPECT_EQ(reason(JointVector::Zero(3)),
            where + "its joints take the tool past its pose by 0.0000 mm and 90.0000 degrees");
  path.space = PathSegment::Space::cartesian;
  EXPECT_EQ(reason(JointVector::Zero(3)), where + "a cartesian segment names joints");
}

TEST(GoalPlanner, RefusesABranchThatTakesTheToolPastItsPose) {
  Gantry gantry;
  gantry.ik.beside_m = 0.02;
  const auto plan = gantry.planner().plan(goal_at(1, 0.5, 0, 0), rest_at(0, 0, 0), kStart);
  ASSERT_FALSE(plan);
  EXPECT_EQ(plan.error().stage, "ik");
  EXPECT_EQ(plan.error().reason,
            "sample 1 of 1 of segment 1: the branch that was taken misses its pose by 20.0000 mm "
            "and 0.0000 degrees");
}

/// A straight way to 50 mm beside the goal.
class BesidePath final : public PathPlanner {
 public:
  Expected<Path> plan(const PathRequest& request) const override {
    ToolPose end = request.goal;
    end.position.z() += 0.05;
    return Path{{.space = PathSegment::Space::joint, .samples = {{1, end}}}};
  }
};

TEST(GoalPlanner, RefusesAPathThatEndsBesideTheGoal) {
  const Gantry gantry;
  const BesidePath path;
  const auto planned = [&](bool path_only) {
    GoalPlanner planner{gantry.model,
                        {path, gantry.ik, gantry.select, gantry.trajectory},
                        gantry.limits,
                        {.path_only = path_only}};
    return planner.plan(goal_at(1, 0.5, 0, 0), rest_at(0, 0, 0), kStart);
  };
  const std::string reason = "the path's end misses the goal by 50.0000 mm and 0.0000 degrees";
  const auto refused = planned(true);
  ASSERT_FALSE(refused);
  EXPECT_EQ(refused.error().stage, "path");
  EXPECT_EQ(refused.error().reason, reason);
  const auto straight = planned(false);
  ASSERT_TRUE(straight) << straight.error().reason;
  EXPECT_EQ(straight->joint_path.back().q.back(), (Eigen::Vector3d{0, 0, 0.5}));
  EXPECT_EQ(straight->straight_because, "path: " + reason);
}

TEST(GoalPlanner, RefusesJointsOfAPathThatTurnByHalfATurnAtOnce) {
  const Gantry stages;
  const RobotModel model = load_robot_model(ARMATURE_SOURCE_DIR "/configs/robots/med7.yaml");
  const AlwaysHome ik;
  JointsPath path;
  GoalPlanner planner{model,
                      {path, ik, stages.select, stages.trajectory},
                      {model.max_velocity(), model.max_acceleration()},
                      {.path_only = true}};
  const JointVector zero = JointVector::Zero(7);
  JointVector start = *model.home();
  start[0] = -2;
  path.detour = start;
  path.detour[0] = 2;
  MotionGoal goal = goal_at(1, 1, 0, 0);
  goal.pose.orientation = Eigen::Quaterniond::Identity();
  EXPECT_EQ(
      planner.plan(goal, {start, zero, zero}, kStart).error().reason,
      "sample 1 of 1 of segment 1: a joint turns by 4.000 rad at once: name a sample between");
}

TEST(GoalPlanner, HandsTheJerkLimitToTheTrajectory) {
  const Gantry gantry;
  MotionLimits limits = gantry.limits;
  limits.max_jerk = JointVector::Constant(3, 7);
  GoalPlanner planner{
      gantry.model, {gantry.path, gantry.ik, gantry.select, gantry.trajectory}, limits, {}};
  ASSERT_TRUE(planner.plan(goal_at(1, 0.5, 0, 0), rest_at(0, 0, 0), kStart));
  EXPECT_EQ(gantry.trajectory.last_request.max_jerk, limits.max_jerk);
}

TEST(GoalPlanner, RefusesATrajectoryThatEndsElsewhereThanItsPath) {
  Gantry gantry;
  gantry.trajectory.ends_off_m = -0.02;
  const auto plan = gantry.planner().plan(goal_at(1, 0.5, 0.6, 0.7), rest_at(0, 0, 0), kStart);
  ASSERT_FALSE(plan);
  EXPECT_EQ(plan.error().stage, "trajectory");
  EXPECT_EQ(plan.error().reason,
            "the trajectory ends elsewhere than its path: joint z at 0.6800 m instead of 0.7000");
}

TEST(GoalPlanner, StopsFirstWhenTheTrajectoryCannotBeSpliced) {
  Gantry gantry;
  gantry.trajectory.jumps = true;  // a plugin that starts from rest whatever it is told
  JointState from = rest_at(0, 0, 0);
  from.v = Eigen::Vector3d{0.5, 0, 0};
  auto plan = gantry.planner().plan(goal_at(1, 0, 0, 1), from, kStart);
  ASSERT_TRUE(plan) << plan.error().reason;
  EXPECT_NEAR(plan->trajectory.at(kStart).v[0], 0.5, 1e-12);
  EXPECT_GE(plan->trajectory.piece_count(), 2);
  EXPECT_NEAR(plan->trajectory.at(plan->trajectory.end()).q[0], 1, 1e-9);
  JointState before = plan->trajectory.at(kStart);
  for (Time t = kStart; t < plan->trajectory.end(); t = t + seconds(0.001)) {
    const JointState state = plan->trajectory.at(t);
    ASSERT_TRUE(t == kStart || test::no_jump(before, state, 0.001));
    before = state;
  }
}

/// Three seconds to 2.02 m, and three to the end: not where the path says.
class SwingingTrajectory final : public TrajectoryPlanner {
 public:
  Expected<Trajectory> plan(const TrajectoryRequest& request) const override {
    const JointVector& end = request.segments.back().q.back();
    Trajectory trajectory{.goal_id = request.goal_id,
                          .dof = static_cast<int>(end.size()),
                          .start = request.start,
                          .knots = {0, 3, 6},
                          .pieces = {}};
    for (const bool out : {true, false}) {
      for (int i = 0; i < trajectory.dof; ++i) {
        const double turn = i == 0 ? 2.02 : end[i];
        trajectory.pieces.push_back(Quintic::between({out ? request.from.q[i] : turn, 0, 0},
                                                     {out ? turn : end[i], 0, 0}, 3));
      }
    }
    return trajectory;
  }
};

TEST(GoalPlanner, NamesTheWayOutWhereTheCurveLeavesTheLimitsBetweenSamplesThatDoNot) {
  Gantry gantry;
  const SwingingTrajectory swings;
  GoalPlanner planner{gantry.model,
                      {gantry.path, gantry.ik, gantry.select, swings},
                      gantry.limits,
                      {.path_only = true}};
  const auto plan = planner.plan(goal_at(1, 0, 0, 1.95), rest_at(1.9, 0, 0), kStart);
  ASSERT_FALSE(plan);
  EXPECT_EQ(plan.error().reason,
            "joint z would reach 2.0200 m between 0.00 and 3.00 s, its limits are -2.0000 and "
            "2.0000 m; no sample of its path does: give the curve between them room with "
            "limit_margin_deg (or _mm)");
}

TEST(GoalPlanner, NamesTheStageWhosePluginThrewAndPlansTheNextGoal) {
  Gantry gantry;
  GoalPlanner planner = gantry.planner();
  const auto failure = [&](bool& throws) {
    throws = true;
    const auto plan = planner.plan(goal_at(1, 1, 1, 1), rest_at(0, 0, 0), kStart);
    throws = false;
    EXPECT_TRUE(planner.plan(goal_at(2, 1, 1, 1), rest_at(0, 0, 0), kStart));
    return plan ? "a plan" : plan.error().stage + ": " + plan.error().reason;
  };
  EXPECT_EQ(failure(gantry.ik.throws), "ik: the goal: the plugin threw: no more of this");
  EXPECT_EQ(failure(gantry.select.throws), "select: the plugin threw: no more of this");
  EXPECT_EQ(failure(gantry.trajectory.throws), "trajectory: the plugin threw: no more of this");
}

TEST(GoalPlanner, GoesStraightInJointSpaceWhenThePathPluginThrows) {
  Gantry gantry;
  gantry.path.throws = true;
  auto plan = gantry.planner().plan(goal_at(1, 1, 1, 1), rest_at(0, 0, 0), kStart);
  ASSERT_TRUE(plan) << plan.error().reason;
  EXPECT_EQ(plan->path.front().space, PathSegment::Space::joint);
  EXPECT_EQ(plan->straight_because, "path: the plugin threw: no more of this");
  gantry.path.throws = false;
  plan = gantry.planner().plan(goal_at(2, 1, 1, 1), rest_at(0, 0, 0), kStart);
  ASSERT_TRUE(plan) << plan.error().reason;
  EXPECT_EQ(plan->straight_because, "");
}

}  // namespace
}  // namespace armature
