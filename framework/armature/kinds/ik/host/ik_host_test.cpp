// SPDX-License-Identifier: Apache-2.0
// The host of the inverse kinematics solvers, with a solver that remembers what it was asked:
// 1. one answer for each request, in order, under its header and id, 2. requests and solutions are
// carried over as they are, 3. bad requests are answered with their exact reason.
#include <gtest/gtest.h>

#include <numbers>
#include <stdexcept>

#include "armature/kinds/ik/ik.hpp"
#include "armature/kinds/request_host_test.hpp"
#include "armature/messages/armature_msgs.hpp"
#include "armature/messages/geometry.hpp"
#include "armature/messages/header.hpp"
#include "armature/robot/kinematics/kinematics.hpp"
#include "armature/robot/model/test_robots.hpp"
#include "armature/runtime/testing/test_plugins.hpp"

namespace armature::ik_host {
namespace {

using testing::joint_vector;

/// Two branches for every good goal; the second is where the seed was.
class EchoIk final : public IkSolver {
 public:
  static inline IkGoal asked;
  static inline IkStatus answer;
  static inline bool throws = false;
  static inline int more_branches = 0;
  static inline std::optional<JointVector> instead;
  static inline std::optional<double> asked_last;

  EchoIk(const RobotModel& robot, const Params&) : robot_{robot} {}
  IkStatus solve(const IkGoal& goal, const JointVector& seed, IkBranches& out,
                 IkState& state) const override {
    out.clear();
    asked = goal;
    asked_last = std::exchange(state.last_redundancy, 7);
    if (const char* wrong = invalid_input(robot_, goal, seed)) {
      return {IkStatus::Code::invalid_input, 0, wrong};
    }
    out.add() = {.label = "up",
                 .q = joint_vector({0.1, 0.2, 0.3, 0.4, 0.5}),
                 .redundancy = 0.25,
                 .residual = {.position_m = 1e-12, .angle_rad = 2e-12},
                 .within_limits = true};
    out.add() = {.label = "seed", .q = seed, .singular = true};
    if (instead) out.add() = {.label = "instead", .q = *instead, .within_limits = true};
    for (int i = 0; i < more_branches; ++i) out.add() = {.label = "one more", .q = seed};
    if (throws) throw std::runtime_error{"the matrix is singular"};
    return answer;
  }
  std::optional<double> redundancy_of(const JointVector& q) const override { return q[0]; }

 private:
  const RobotModel& robot_;
};

PluginRegistry& plugins() {
  return built_plugins_with<EchoIk>("{armature_plugin: 1, id: ik/echo, kind: ik}");
}

msg::IkRequest request(std::uint64_t id) {
  msg::IkRequest message;
  write_header(message.header_(), Time{static_cast<std::int64_t>(id) * 1000}, kBaseFrame);
  message.request_id_(id);
  assign(message.position_(), Eigen::Vector3d{1, 2, 3});
  message.pointing_(true);
  assign(message.direction_(), Eigen::Vector3d{0, 1, 0});
  return message;
}

class IkHostTest : public RequestHostTest<msg::IkRequest, msg::IkResponse> {
 protected:
  IkHostTest()
      : RequestHostTest{
            plugins(),
            {.component = "{plugin: ik/echo}",
             .robot = config::load(ARMATURE_SOURCE_DIR "/configs/robots/dental_lamp.yaml")}} {
    EchoIk::answer = {};
    EchoIk::throws = false;
  }
};

TEST_F(IkHostTest, AnswersEveryRequestOnceInOrderUnderItsHeaderAndId) {
  expect_answered_in_order({request(7), request(3), request(3), request(9)});
}

TEST_F(IkHostTest, AsksForThePoseOfTheRequest) {
  msg::IkRequest message = request(1);
  ask(message);
  EXPECT_EQ(EchoIk::asked.pose.position, (Eigen::Vector3d{1, 2, 3}));
  EXPECT_EQ(std::get<Direction>(EchoIk::asked.pose.orientation).unit, Eigen::Vector3d::UnitY());
  EXPECT_FALSE(EchoIk::asked.redundancy);
  message.pointing_(false);
  assign(message.orientation_(), Eigen::Quaterniond{0.5, 0.5, -0.5, 0.5});
  message.has_redundancy_(true);
  message.redundancy_(0.75);
  ask(message);
  EXPECT_EQ(std::get<Eigen::Quaterniond>(EchoIk::asked.pose.orientation).coeffs(),
            (Eigen::Quaterniond{0.5, 0.5, -0.5, 0.5}.coeffs()));
  EXPECT_EQ(EchoIk::asked.redundancy, 0.75);
}

TEST_F(IkHostTest, TellsEveryBranchWithAllJoints) {
  const msg::IkResponse answer = ask(request(1));
  EXPECT_EQ(answer.status_(), "ok");
  EXPECT_EQ(answer.reason_(), "");
  ASSERT_EQ(answer.solutions_().size(), 2u);
  const msg::IkSolution& up = answer.solutions_()[0];
  EXPECT_EQ(up.label_(), "up");
  EXPECT_EQ(up.joints_(), (std::vector<double>{0.1, 0.2, 0.3, -0.3, 0.4, 0.5}));
  EXPECT_EQ(up.redundancy_(), 0.25);
  EXPECT_TRUE(up.within_limits_());
  EXPECT_FALSE(up.singular_());
  EXPECT_TRUE(answer.solutions_()[1].singular_());
}

TEST_F(IkHostTest, StartsFromTheSeedOrFromHomeWithoutOne) {
  const RobotModel lamp = testing::dental_lamp();
  const auto home = ask(request(1)).solutions_()[1].joints_();
  EXPECT_EQ(lamp.to_independent(home).value(), lamp.to_independent(*lamp.home()).value());
  msg::IkRequest seeded = request(2);
  seeded.seed_({0.5, -0.5, 0.25, -0.25, 1, 0.125});
  EXPECT_EQ(ask(seeded).solutions_()[1].joints_(), seeded.seed_());
}

TEST_F(IkHostTest, WhatIsRememberedFollowsFromTheSeedAndNotFromTheRequestBefore) {
  msg::IkRequest seeded = request(1);
  seeded.seed_({0.5, -0.5, 0.25, -0.25, 1, 0.125});
  for (int i = 0; i < 2; ++i) {
    ask(seeded);
    EXPECT_EQ(EchoIk::asked_last, 0.5);
  }
}

TEST_F(IkHostTest, AnAnswerThatIsNoJointPositionIsAReason) {
  const auto refusal = [&](const JointVector& q) {
    EchoIk::instead = q;
    const msg::IkResponse answer = ask(request(1));
    EchoIk::instead.reset();
    EXPECT_EQ(answer.status_(), "no_convergence");
    EXPECT_TRUE(answer.solutions_().empty());
    return answer.reason_();
  };
  EXPECT_EQ(refusal(JointVector::Zero(3)), "the plugin answered 3 joints, and the robot has 5");
  EXPECT_EQ(refusal(JointVector::Constant(5, NAN)),
            "the plugin answered joints that are not finite");
  EXPECT_EQ(ask(request(2)).status_(), "ok");
}

TEST_F(IkHostTest, JointsThatAreCalledWithinLimitsAreWithinThemAsNearToTheSeedAsTheyAllow) {
  msg::IkRequest seeded = request(1);
  seeded.seed_({0, 0, 0, 0, -1, 0});
  const auto told = [&](const JointVector& q) {
    EchoIk::instead = q;
    const msg::IkResponse answer = ask(seeded);
    EchoIk::instead.reset();
    return answer.solutions_().at(2);
  };
  constexpr double kTurn = 2 * std::numbers::pi;
  const msg::IkSolution turned = told(joint_vector({0.1 - kTurn, 0.2, 0.3, 0.4 + kTurn, 0.5}));
  const std::vector<double> wanted{0.1, 0.2, 0.3, -0.3, 0.4, 0.5};
  ASSERT_EQ(turned.joints_().size(), 6u);
  for (std::size_t j = 0; j < 6; ++j) EXPECT_NEAR(turned.joints_()[j], wanted[j], 1e-12) << j;
  EXPECT_TRUE(turned.within_limits_());
  const msg::IkSolution outside = told(joint_vector({0.1, 0.2, 2, 0.4, 0.5}));
  EXPECT_EQ(outside.joints_()[2], 2);
  EXPECT_FALSE(outside.within_limits_()) << "whatever the plugin says";
}

TEST_F(IkHostTest, TellsHowFarFromTheGoalForwardKinematicsFindsTheJoints) {
  const RobotModel lamp = testing::dental_lamp();
  const msg::IkSolution up = ask(request(1)).solutions_()[0];
  const PoseResidual off =
      residual(forward_kinematics(lamp, joint_vector({0.1, 0.2, 0.3, 0.4, 0.5})),
               *lamp.pointing_axis(), {{1, 2, 3}, Direction{{0, 1, 0}}});
  EXPECT_EQ(up.residual_m_(), off.position_m);
  EXPECT_EQ(up.residual_rad_(), off.angle_rad);
}

TEST_F(IkHostTest, HandsOnTheStatusWithItsReasonAndWhatWasFoundAllTheSame) {
  EchoIk::answer = {IkStatus::Code::joint_limit, 0, "j5 at no turn"};
  const msg::IkResponse limit = ask(request(1));
  EXPECT_EQ(limit.status_(), "joint_limit");
  EXPECT_EQ(limit.reason_(), "joint_limit: j5 at no turn");
  EXPECT_EQ(limit.solutions_().size(), 2u);
  EchoIk::answer = {IkStatus::Code::out_of_reach, 0.0341, "horizontal distance"};
  EXPECT_EQ(ask(request(2)).reason_(), "out_of_reach: 0.0341 m beyond reach (horizontal distance)");
}

TEST_F(IkHostTest, AnswersABadRequestWithItsReasonAndTheNextOneAsIfNothingHadBeen) {
  const auto refusal = [&](auto change) {
    msg::IkRequest bad = request(5);
    change(bad);
    const msg::IkResponse answer = ask(bad);
    EXPECT_EQ(answer.status_(), "invalid_input");
    EXPECT_EQ(answer.request_id_(), 5u);
    EXPECT_TRUE(answer.solutions_().empty());
    EXPECT_EQ(ask(request(6)).status_(), "ok");
    return answer.reason_();
  };
  EXPECT_EQ(refusal([](auto& r) { r.position_().y_(NAN); }), "the goal's position is not finite");
  EXPECT_EQ(refusal([](auto& r) { r.direction_().y_(0.01); }),
            "the goal's direction has length 0.01, not 1");
  EXPECT_EQ(refusal([](auto& r) {
              r.pointing_(false);
              assign(r.orientation_(), Eigen::Quaterniond{0.3, 0, 0, 0});
            }),
            "the goal's quaternion has length 0.3, not 1");
  EXPECT_EQ(refusal([](auto& r) {
              r.has_redundancy_(true);
              r.redundancy_(INFINITY);
            }),
            "invalid_input: the redundancy is not finite");
  EXPECT_EQ(refusal([](auto& r) {
              r.seed_({1, 2, 3});
            }),
            "the seed: 3 joint values; dental_lamp has 6 joints");
  EXPECT_EQ(refusal([](auto& r) {
              r.seed_({0, 0, NAN, 0, 0, 0});
            }),
            "the seed: j3 = nan is not a number");
  EXPECT_EQ(refusal([](auto& r) {
              r.seed_({0, 0, 0.5, 0.5, 0, 0});
            }),
            "the seed: j4 = 0.5 contradicts its coupling to j3, which makes it -0.5");
  EXPECT_EQ(refusal([](auto& r) { r.seed_(std::vector<double>(1000, 0.0)); }),
            "the seed: 1000 joint values; dental_lamp has 6 joints");
  EXPECT_EQ(refusal([](auto& r) { r.header_().frame_id_() = "camera"; }),
            "the request is stated in frame 'camera', not in 'base'");
}

TEST_F(IkHostTest, TakesARequestWithoutAFrameForOneInTheBaseFrame) {
  msg::IkRequest message = request(1);
  message.header_().frame_id_().clear();
  EXPECT_EQ(ask(message).status_(), "ok");
}

TEST(IkHost, DoesNotStartWithARobotThatTheSolverRefuses) {
  const config::Node refused = config::parse_text(
      "{armature_robot: 1, name: one, joints: [{name: j1, a_m: 1, limits_deg: [-90, 90], "
      "velocity_rad_s: 1, acceleration_rad_s2: 1}], frames: {tool: {parent: j1}}}",
      "one.yaml");
  class Refusing final : public IkSolver {
   public:
    static Expected<std::unique_ptr<IkSolver>> make(const RobotModel& robot, const Params&) {
      return refuse(robot.name() + " has too few joints");
    }
    IkStatus solve(const IkGoal&, const JointVector&, IkBranches&, IkState&) const override {
      return {};
    }
  };
  PluginRegistry registry{{ARMATURE_PLUGIN_BUILD_DIR}};
  registry.add<Refusing>("{armature_plugin: 1, id: ik/refusing, kind: ik}");
  try {
    ComponentHarness host{registry, {.component = "{plugin: ik/refusing}", .robot = refused}};
    ADD_FAILURE() << "it was made";
  } catch (const SetupError& error) {
    EXPECT_STREQ(error.what(), "ik/refusing refuses: one has too few joints");
  }
}

TEST_F(IkHostTest, AnExceptionOfTheSolverIsAReasonAndTheNextRequestIsAnswered) {
  EchoIk::throws = true;
  const msg::IkResponse answer = ask(request(1));
  EXPECT_EQ(answer.status_(), "no_convergence");
  EXPECT_EQ(answer.reason_(), "the plugin threw: the matrix is singular");
  EXPECT_TRUE(answer.solutions_().empty());
  EchoIk::throws = false;
  EXPECT_EQ(ask(request(2)).status_(), "ok");
}

TEST_F(IkHostTest, ASolverThatAddsMoreBranchesThanThereIsRoomForIsToldSo) {
  EchoIk::more_branches = IkBranches::kCapacity - 2;
  EXPECT_EQ(ask(request(1)).status_(), "ok");
  ++EchoIk::more_branches;
  EXPECT_EQ(ask(request(2)).reason_(), "the plugin threw: the solver adds more than 16 branches");
  EchoIk::more_branches = 0;
}

}  // namespace
}  // namespace armature::ik_host
