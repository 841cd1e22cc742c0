// SPDX-License-Identifier: Apache-2.0
// The host of the branch selectors: 1. one answer for each request, in order, under its header and
// id, 2. branches and choices are carried over as they are, 3. bad requests are answered with their
// exact reason.
#include <gtest/gtest.h>

#include <stdexcept>

#include "armature/kinds/request_host_test.hpp"
#include "armature/kinds/select/select.hpp"
#include "armature/messages/armature_msgs.hpp"
#include "armature/messages/header.hpp"
#include "armature/robot/model/test_robots.hpp"
#include "armature/runtime/testing/test_plugins.hpp"

namespace armature::select_host {
namespace {

using testing::joint_vector;

/// The last branch of every waypoint.
class LastBranch final : public BranchSelector {
 public:
  static inline JointVector start;
  static inline std::vector<IkBranches> asked;
  static inline std::string label;
  static inline bool throws = false;
  static inline std::optional<std::vector<JointVector>> instead;

  Expected<std::vector<JointVector>> choose(const JointVector& from,
                                            std::span<const IkBranches> waypoints) const override {
    start = from;
    asked.assign(waypoints.begin(), waypoints.end());
    if (throws) throw std::runtime_error{"the matrix is singular"};
    if (instead) return *instead;
    std::vector<JointVector> chosen;
    for (const IkBranches& branches : waypoints) {
      if (branches.count == 0) {
        return refuse("waypoint " + std::to_string(chosen.size() + 1) + ": no branch");
      }
      const IkBranch& last = *(branches.end() - 1);
      label = last.label;
      chosen.push_back(last.q);
    }
    return chosen;
  }
};

PluginRegistry& plugins() {
  return built_plugins_with<LastBranch>("{armature_plugin: 1, id: select/last, kind: select}");
}

msg::IkSolution solution(const std::string& label, std::vector<double> joints) {
  msg::IkSolution message;
  message.label_(label);
  message.joints_(std::move(joints));
  message.residual_m_(1e-12);
  message.residual_rad_(2e-12);
  message.redundancy_(0.5);
  message.within_limits_(true);
  message.singular_(label == "down");
  return message;
}

msg::SelectRequest request(std::uint64_t id) {
  msg::SelectRequest message;
  write_header(message.header_(), Time{static_cast<std::int64_t>(id) * 1000}, kBaseFrame);
  message.request_id_(id);
  message.start_({1, 2, 0.3, -0.3, 0.4, 0.5});
  message.waypoints_().resize(2);
  message.waypoints_()[0].solutions_() = {solution("up", {0, 0, 0.1, -0.1, 0, 0}),
                                          solution("down", {1, 0, 0.2, -0.2, 0, 1})};
  message.waypoints_()[1].solutions_() = {solution("up", {2, 0, 0.4, -0.4, 0, 0})};
  return message;
}

class SelectHostTest : public RequestHostTest<msg::SelectRequest, msg::SelectResponse> {
 protected:
  SelectHostTest()
      : RequestHostTest{
            plugins(),
            {.component = "{plugin: select/last}",
             .robot = config::load(ARMATURE_SOURCE_DIR "/configs/robots/dental_lamp.yaml")}} {}
};

TEST_F(SelectHostTest, AnswersEveryRequestOnceInOrderUnderItsHeaderAndId) {
  msg::SelectRequest bad = request(3);
  bad.waypoints_()[1].solutions_().clear();
  expect_bad_one_refused_between(request(7), bad, request(9));
}

TEST_F(SelectHostTest, AsksWithTheIndependentJointsOfEverySolution) {
  ask(request(1));
  EXPECT_EQ(LastBranch::start, joint_vector({1, 2, 0.3, 0.4, 0.5}));
  ASSERT_EQ(LastBranch::asked.size(), 2u);
  ASSERT_EQ(LastBranch::asked[0].count, 2);
  const IkBranch& down = LastBranch::asked[0].branch[1];
  EXPECT_EQ(down.q, joint_vector({1, 0, 0.2, 0, 1}));
  EXPECT_EQ(down.residual.position_m, 1e-12);
  EXPECT_EQ(down.residual.angle_rad, 2e-12);
  EXPECT_EQ(down.redundancy, 0.5);
  EXPECT_TRUE(down.within_limits);
  EXPECT_TRUE(down.singular);
  EXPECT_FALSE(LastBranch::asked[0].branch[0].singular);
  EXPECT_EQ(LastBranch::asked[1].count, 1);
  EXPECT_EQ(LastBranch::label, "up");
}

TEST_F(SelectHostTest, StartsFromHomeWhenNoStartIsGiven) {
  const RobotModel lamp = testing::dental_lamp();
  msg::SelectRequest from_home = request(1);
  from_home.start_().clear();
  EXPECT_TRUE(ask(from_home).valid_());
  EXPECT_EQ(LastBranch::start, lamp.to_independent(*lamp.home()).value());
}

TEST_F(SelectHostTest, TellsAllJointsOfEveryChoice) {
  const msg::SelectResponse answer = ask(request(1));
  EXPECT_EQ(answer.reason_(), "");
  ASSERT_EQ(answer.waypoints_().size(), 2u);
  EXPECT_EQ(answer.waypoints_()[0].joints_(), (std::vector<double>{1, 0, 0.2, -0.2, 0, 1}));
  EXPECT_EQ(answer.waypoints_()[1].joints_(), (std::vector<double>{2, 0, 0.4, -0.4, 0, 0}));
}

TEST_F(SelectHostTest, APathWithoutWaypointsIsOne) {
  msg::SelectRequest empty = request(1);
  empty.waypoints_().clear();
  const msg::SelectResponse answer = ask(empty);
  EXPECT_TRUE(answer.valid_());
  EXPECT_TRUE(answer.waypoints_().empty());
}

TEST_F(SelectHostTest, AnswersABadRequestWithItsReasonAndTheNextOneAsIfNothingHadBeen) {
  const auto refusal = [&](auto change) {
    msg::SelectRequest bad = request(5);
    change(bad);
    return refusal_of(bad, request(6));
  };
  EXPECT_EQ(refusal([](auto& r) {
              r.start_({1, 2});
            }),
            "the start: 2 joint values; dental_lamp has 6 joints");
  EXPECT_EQ(refusal([](auto& r) { r.start_()[1] = NAN; }), "the start: j2 = nan is not a number");
  EXPECT_EQ(refusal([](auto& r) { r.waypoints_()[0].solutions_()[1].joints_().pop_back(); }),
            "waypoint 1, solution 2: 5 joint values; dental_lamp has 6 joints");
  EXPECT_EQ(refusal([](auto& r) { r.waypoints_()[1].solutions_()[0].joints_()[5] = INFINITY; }),
            "waypoint 2, solution 1: j6 = inf is not a number");
  EXPECT_EQ(refusal([](auto& r) { r.waypoints_()[1].solutions_()[0].joints_()[3] = 1; }),
            "waypoint 2, solution 1: j4 = 1 contradicts its coupling to j3, which makes it -0.4");
  EXPECT_EQ(refusal([](auto& r) {
              r.waypoints_()[1].solutions_().assign(17, r.waypoints_()[1].solutions_()[0]);
            }),
            "waypoint 2 has 17 solutions, at most 16 are read");
  EXPECT_EQ(refusal([](auto& r) { r.waypoints_()[1].solutions_().clear(); }),
            "waypoint 2: no branch");
}

TEST_F(SelectHostTest, AnAnswerThatIsNoneIsRefused) {
  const JointVector q = JointVector::Zero(5);
  const auto refusal = [&](std::vector<JointVector> answered) {
    LastBranch::instead = std::move(answered);
    const msg::SelectResponse answer = ask(request(1));
    LastBranch::instead.reset();
    EXPECT_FALSE(answer.valid_());
    EXPECT_TRUE(answer.waypoints_().empty());
    return answer.reason_();
  };
  EXPECT_EQ(refusal({q}), "the plugin answered for 1 of 2 waypoints");
  EXPECT_EQ(refusal({q, q, q}), "the plugin answered for 3 of 2 waypoints");
  EXPECT_EQ(refusal({q, JointVector::Zero(3)}),
            "waypoint 2 of 2: the plugin's answer has 3 joints, not the 5 independent ones of "
            "dental_lamp");
  EXPECT_EQ(refusal({JointVector::Constant(5, NAN), q}),
            "waypoint 1 of 2: the plugin's answer is not finite");
}

TEST_F(SelectHostTest, AnExceptionOfThePluginIsAReasonAndTheNextRequestIsAnswered) {
  expect_survives(LastBranch::throws, request(1));
}

}  // namespace
}  // namespace armature::select_host
