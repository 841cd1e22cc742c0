// SPDX-License-Identifier: Apache-2.0
// The host of the trajectory planners: 1. one answer for each request, in order, under its header
// and id, 2. requests and trajectories are carried over as they are, 3. bad requests are answered
// with their exact reason, 4. a trajectory that breaks what was asked for is no answer.
#include <gtest/gtest.h>

#include <stdexcept>

#include "armature/kinds/request_host_test.hpp"
#include "armature/kinds/trajectory/trajectory_planner.hpp"
#include "armature/messages/armature_msgs.hpp"
#include "armature/messages/header.hpp"
#include "armature/robot/model/test_robots.hpp"
#include "armature/runtime/testing/test_plugins.hpp"

namespace armature::trajectory_host {
namespace {

using testing::joint_vector;

/// One quintic of 2 s from the start to the last waypoint; refuses to last no time.
class TwoSeconds final : public TrajectoryPlanner {
 public:
  static inline TrajectoryRequest asked;
  static inline bool throws = false;
  static inline double overshoot = 0;  // of the first joint

  Expected<Trajectory> plan(const TrajectoryRequest& request) const override {
    if (throws) throw std::runtime_error{"the matrix is singular"};
    asked = request;
    const JointVector& end = request.segments.back().q.back();
    if (request.segments.front().duration_s == 0.0) return refuse("segment 1 lasts no time");
    Trajectory trajectory{.goal_id = request.goal_id,
                          .dof = static_cast<int>(end.size()),
                          .start = request.start,
                          .knots = {0, 2},
                          .pieces = {}};
    for (int i = 0; i < end.size(); ++i) {
      const JointState& from = request.from;
      trajectory.pieces.push_back(Quintic::between({from.q[i], from.v[i], from.a[i]},
                                                   {end[i] + (i == 0 ? overshoot : 0), 0, 0}, 2));
    }
    return trajectory;
  }
};

PluginRegistry& plugins() {
  return built_plugins_with<TwoSeconds>(
      "{armature_plugin: 1, id: trajectory/two_seconds, kind: trajectory}");
}

msg::JointPosition at(std::vector<double> joints) {
  msg::JointPosition position;
  position.joints_(std::move(joints));
  return position;
}

msg::TrajectoryRequest request(std::uint64_t id) {
  msg::TrajectoryRequest message;
  write_header(message.header_(), Time{static_cast<std::int64_t>(id) * 1'500'000'000}, kBaseFrame);
  message.request_id_(id);
  message.segments_().resize(2);
  msg::JointSegment &first = message.segments_()[0], &second = message.segments_()[1];
  first.s_({0, 1});
  first.waypoints_() = {at({0, 0, 0.1, -0.1, 0, 0}), at({1, 0, 0.2, -0.2, 0, 1})};
  first.stop_at_end_(false);
  second.s_({0, 0.25, 1});
  second.waypoints_() = {first.waypoints_()[1], at({1, 1, 0, 0, 0, 0}),
                         at({2, 0, 0.4, -0.4, 0, 0})};
  second.stop_at_end_(true);
  second.has_duration_(true);
  second.duration_(3.5);
  return message;
}

class TrajectoryHostTest : public RequestHostTest<msg::TrajectoryRequest, msg::TrajectoryResponse> {
 protected:
  TrajectoryHostTest()
      : RequestHostTest{
            plugins(),
            {.component = "{plugin: trajectory/two_seconds}",
             .robot = config::load(ARMATURE_SOURCE_DIR "/configs/robots/dental_lamp.yaml")}} {}
};

TEST_F(TrajectoryHostTest, AnswersEveryRequestOnceInOrderUnderItsHeaderAndId) {
  msg::TrajectoryRequest bad = request(3);
  bad.segments_().clear();
  expect_bad_one_refused_between(request(7), bad, request(9));
}

TEST_F(TrajectoryHostTest, AsksForTheSegmentsInIndependentJointsFromRestWithTheRobotsLimits) {
  const RobotModel lamp = testing::dental_lamp();
  ask(request(4));
  const TrajectoryRequest& asked = TwoSeconds::asked;
  EXPECT_EQ(asked.goal_id, 4u);
  EXPECT_EQ(asked.start, Time{6'000'000'000});
  EXPECT_EQ(asked.from.q, joint_vector({0, 0, 0.1, 0, 0}));
  EXPECT_EQ(asked.from.v, JointVector::Zero(5));
  EXPECT_EQ(asked.from.a, JointVector::Zero(5));
  EXPECT_EQ(asked.max_velocity, lamp.max_velocity());
  EXPECT_EQ(asked.max_acceleration, lamp.max_acceleration());
  ASSERT_EQ(asked.segments.size(), 2u);
  EXPECT_FALSE(asked.segments[0].stop_at_end);
  EXPECT_FALSE(asked.segments[0].duration_s);
  EXPECT_EQ(asked.segments[1].s, (std::vector<double>{0, 0.25, 1}));
  EXPECT_EQ(asked.segments[1].q[2], joint_vector({2, 0, 0.4, 0, 0}));
  EXPECT_EQ(asked.segments[1].duration_s, 3.5);
}

TEST_F(TrajectoryHostTest, AsksWithTheRequestsOwnStartAndLimits) {
  msg::TrajectoryRequest moving = request(1);
  moving.start_velocity_({0.1, 0.2, 0.3, -0.3, 0.4, 0.5});
  moving.start_acceleration_({0.1, 0.2, 0.3, -0.3, 0.4, 0.5});
  moving.max_velocity_({2.5, 1, 1, 0.5, 1, 2.5});  // the one that follows binds its leader
  moving.max_acceleration_({8, 8, 2, 8, 8, 8});
  EXPECT_TRUE(ask(moving).valid_());
  const TrajectoryRequest& asked = TwoSeconds::asked;
  EXPECT_EQ(asked.from.v, joint_vector({0.1, 0.2, 0.3, 0.4, 0.5}));
  EXPECT_EQ(asked.from.a, joint_vector({0.1, 0.2, 0.3, 0.4, 0.5}));
  EXPECT_EQ(asked.max_velocity, joint_vector({2.5, 1, 0.5, 1, 2.5}));
  EXPECT_EQ(asked.max_acceleration, joint_vector({8, 8, 2, 8, 8}));
}

TEST_F(TrajectoryHostTest, TellsTheTrajectoryAsItIs) {
  const msg::TrajectoryResponse answer = ask(request(4));
  EXPECT_EQ(answer.reason_(), "");
  const msg::QuinticTrajectory& told = answer.trajectory_();
  EXPECT_EQ(stamp_of(told.header_().stamp_()), Time{6'000'000'000});
  EXPECT_EQ(told.header_().frame_id_(), "base");
  EXPECT_EQ(told.goal_id_(), 4u);
  EXPECT_EQ(told.joint_names_(), (std::vector<std::string>{"j1", "j2", "j3", "j5", "j6"}));
  EXPECT_EQ(told.knots_(), (std::vector<double>{0, 2}));
  ASSERT_EQ(told.coefficients_().size(), 5u * 6u);
  const Quintic j3 = Quintic::between({0.1, 0, 0}, {0.4, 0, 0}, 2);
  for (std::size_t k = 0; k < 6; ++k) EXPECT_EQ(told.coefficients_()[2 * 6 + k], j3.c[k]);
}

TEST_F(TrajectoryHostTest, AnswersABadRequestWithItsReasonAndTheNextOneAsIfNothingHadBeen) {
  const auto refusal = [&](auto change) {
    msg::TrajectoryRequest bad = request(5);
    change(bad);
    return refusal_of(bad, request(6));
  };
  EXPECT_EQ(refusal([](auto& r) { r.segments_().clear(); }), "there is no waypoint");
  EXPECT_EQ(refusal([](auto& r) { r.segments_()[0].waypoints_().clear(); }),
            "there is no waypoint");
  EXPECT_EQ(refusal([](auto& r) { r.segments_()[1].waypoints_()[2].joints_()[0] = NAN; }),
            "segment 2, waypoint 3: j1 = nan is not a number");
  EXPECT_EQ(refusal([](auto& r) { r.segments_()[1].waypoints_()[0].joints_().clear(); }),
            "segment 2, waypoint 1: 0 joint values; dental_lamp has 6 joints");
  EXPECT_EQ(refusal([](auto& r) {
              r.start_velocity_({1, 2});
            }),
            "start_velocity: 2 joint values; dental_lamp has 6 joints");
  EXPECT_EQ(refusal([](auto& r) {
              r.start_acceleration_({0, 0, 1, 1, 0, 0});
            }),
            "start_acceleration: j4 = 1 contradicts its coupling to j3, which makes it -1");
  EXPECT_EQ(refusal([](auto& r) {
              r.max_velocity_({1, 1, 1, 1, 1});
            }),
            "max_velocity: 5 joint values; dental_lamp has 6 joints");
  EXPECT_EQ(refusal([](auto& r) {
              r.max_velocity_({1, 1, 1, 1, 9, 1});
            }),
            "max_velocity: j5 = 9 is not above 0 and at most the robot's 2.5");
  EXPECT_EQ(refusal([](auto& r) {
              r.max_acceleration_({1, NAN, 1, 1, 1, 1});
            }),
            "max_acceleration: j2 = nan is not above 0 and at most the robot's 8");
  EXPECT_EQ(refusal([](auto& r) {
              r.segments_()[0].has_duration_(true);
              r.segments_()[0].duration_(0);
            }),
            "segment 1 lasts no time");
}

TEST_F(TrajectoryHostTest, ATrajectoryThatBreaksALimitIsNoAnswer) {
  TwoSeconds::overshoot = 1.5;
  const msg::TrajectoryResponse answer = ask(request(1));
  TwoSeconds::overshoot = 0;
  EXPECT_FALSE(answer.valid_());
  EXPECT_EQ(answer.reason_(),
            "joint j1 would reach 3.5000 rad between 0.00 and 2.00 s, its limits are -2.9671 and "
            "2.9671 rad");
  EXPECT_EQ(answer.trajectory_(), msg::QuinticTrajectory{});
  msg::TrajectoryRequest slow = request(2);
  slow.max_velocity_({1, 2.5, 2.5, 2.5, 2.5, 2.5});
  EXPECT_EQ(ask(slow).reason_(),
            "joint j1 would need 1.8750 rad/s between 0.00 and 2.00 s, its limit is 1.0000");
  EXPECT_TRUE(ask(request(3)).valid_());
}

TEST_F(TrajectoryHostTest, ATrajectoryThatEndsElsewhereThanAtTheLastWaypointIsNoAnswer) {
  TwoSeconds::overshoot = 0.125;
  const msg::TrajectoryResponse answer = ask(request(1));
  TwoSeconds::overshoot = 0;
  EXPECT_FALSE(answer.valid_());
  EXPECT_EQ(answer.reason_(),
            "the trajectory ends elsewhere than its path: joint j1 at 2.1250 rad instead of "
            "2.0000");
}

TEST_F(TrajectoryHostTest, AnExceptionOfThePluginIsAReasonAndTheNextRequestIsAnswered) {
  expect_survives(TwoSeconds::throws, request(1));
}

/// One joint that turns, on a column that is locked.
class LiftedTrajectoryHostTest
    : public RequestHostTest<msg::TrajectoryRequest, msg::TrajectoryResponse> {
 protected:
  LiftedTrajectoryHostTest()
      : RequestHostTest{
            plugins(),
            {.component = "{plugin: trajectory/two_seconds}",
             .robot = config::parse_text(
                 "armature_robot: 1\nname: lifted\njoints:\n"
                 "  - {name: column, type: prismatic, locked: true, limits_mm: [0, 800], "
                 "velocity_m_s: 0.05, acceleration_m_s2: 0.1}\n"
                 "  - {name: turn, limits_deg: [-90, 90], velocity_rad_s: 2, "
                 "acceleration_rad_s2: 8}\n"
                 "frames: {tool: {parent: turn}}\nhome: [0.1, 0]\n",
                 "lifted.yaml")}} {}
};

TEST_F(LiftedTrajectoryHostTest, LimitsOfAJointThatIsLockedBindNothing) {
  msg::TrajectoryRequest limited;
  write_header(limited.header_(), Time{1'000'000'000}, kBaseFrame);
  limited.request_id_(1);
  limited.segments_().resize(1);
  limited.segments_()[0].s_({0, 1});
  limited.segments_()[0].waypoints_() = {at({0.1, 0}), at({0.1, 0.5})};
  limited.segments_()[0].stop_at_end_(true);
  limited.max_velocity_({0.05, 1});
  limited.max_acceleration_({0.1, 4});
  limited.max_jerk_({1, 50});
  EXPECT_EQ(ask(limited).reason_(), "");
  EXPECT_EQ(TwoSeconds::asked.max_velocity, joint_vector({1}));
  EXPECT_EQ(TwoSeconds::asked.max_acceleration, joint_vector({4}));
  EXPECT_EQ(TwoSeconds::asked.max_jerk, joint_vector({50}));
}

}  // namespace
}  // namespace armature::trajectory_host
