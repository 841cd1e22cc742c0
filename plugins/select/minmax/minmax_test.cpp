// SPDX-License-Identifier: Apache-2.0
#include "minmax.hpp"

#include <gtest/gtest.h>

#include "armature/kinds/select/contract.hpp"
#include "armature/values/angles.hpp"
#include "test_robots.hpp"

namespace armature::select::minmax {
namespace {

constexpr auto kFree = Parameters::FirstMove::free;

Expected<std::vector<JointVector>> choose(const JointVector& start,
                                          const std::vector<IkBranches>& waypoints,
                                          const Parameters& parameters = {}) {
  const RobotModel model = crane();
  return MinMax{model, parameters}.choose(start, waypoints);
}

SelectSubject subject(const std::string& name, const RobotModel& model,
                      const Parameters& parameters = {}) {
  const auto shared = std::make_shared<const RobotModel>(model);
  return {name, shared, std::make_shared<MinMax>(*shared, parameters)};
}

INSTANTIATE_TEST_SUITE_P(
    MinMax, SelectLaws,
    testing::Values(
        subject("crane", crane()), subject("crane_from_anywhere", crane(), {.first_move = kFree}),
        subject("crane_in_one_branch", crane(), {.one_branch = true}),
        subject("crane_without_jumps", crane(), {.jump_limit = 360 * kRadPerDegree}),
        subject("winder", winder()),
        subject("lamp", load_robot_model(ARMATURE_SOURCE_DIR "/configs/robots/dental_lamp.yaml"))),
    testing::PrintToStringParamName());

IkBranches labelled(const std::vector<std::pair<const char*, JointVector>>& all) {
  IkBranches result;
  for (const auto& [label, q] : all) {
    IkBranch& branch = result.add();
    branch.label = label;
    branch.q = q;
  }
  return result;
}

TEST(MinMax, AvoidsTheGreatMoveThatTheNearestBranchLeadsTo) {
  // The near branch ends where only a long way goes on.
  const std::vector<IkBranches> waypoints{branches({joints(0.1, 0, 0), joints(-0.5, 0, 0)}),
                                          branches({joints(-1.0, 0, 0)}),
                                          branches({joints(-1.5, 0, 0)})};
  const auto path = choose(joints(0, 0, 0), waypoints);
  ASSERT_TRUE(path) << path.error().text;
  EXPECT_EQ((*path)[0], joints(-0.5, 0, 0));
}

TEST(MinMax, AmongEqualGreatestMovesTheSumDecides) {
  // 1 s must be spent in the last move; before that the second branch is the shorter way.
  const std::vector<IkBranches> waypoints{branches({joints(0.6, 0, 0), joints(0.2, 0, 0)}),
                                          branches({joints(0, 0, 0)}), branches({joints(1, 0, 0)})};
  EXPECT_EQ(choose(joints(0, 0, 0), waypoints)->front(), joints(0.2, 0, 0));
}

TEST(MinMax, ATieGoesToTheSolversFirstBranch) {
  const std::vector<IkBranches> waypoints{
      branches({joints(0.5, 0, 0), joints(-0.5, 0, 0)}),
      branches({joints(1 + 1e-13, 0, 0), joints(-1, 0, 0)})};  // rounding does not choose
  EXPECT_EQ(choose(joints(0, 0, 0), waypoints)->back(), joints(1 + 1e-13, 0, 0));
}

TEST(MinMax, AMoveIsAsLongAsItsSlowestJointNeeds) {
  const std::vector<IkBranches> two{branches({joints(0.5, 0, 0), joints(0, 1.6, 0)})};
  EXPECT_EQ(choose(joints(0, 0, 0), two)->front(), joints(0, 1.6, 0));
}

TEST(MinMax, FollowsAJointBeyondHalfATurn) {
  const std::vector<IkBranches> waypoints{branches({joints(2, 0, 0)}), branches({joints(3, 0, 0)}),
                                          branches({joints(-3, 0, 0)})};
  EXPECT_NEAR(choose(joints(1, 0, 0), waypoints)->back()[0], -3 + 2 * M_PI, 1e-12);
}

TEST(MinMax, ArrivesAtABranchByTheTurnThatThePathNeedsLater) {
  // The shorter way to 3.1 rad ends at the limit, one move before the goal; 3.1 - 2 pi does not.
  const std::vector<IkBranches> waypoints{
      branches({joints(2.2, 0, 0), joints(-2.3, 0, 0)}), branches({joints(3.1, 0, 0)}),
      branches({joints(3.9 - 2 * M_PI, 0, 0)}), branches({joints(4.2 - 2 * M_PI, 0, 0)})};
  const auto path = choose(joints(0, 0, 0), waypoints);
  EXPECT_EQ((*path)[0], joints(-2.3, 0, 0));
  EXPECT_NEAR((*path)[1][0], 3.1 - 2 * M_PI, 1e-12);
}

TEST(MinMax, AFreeFirstMoveMayBeTheGreatest) {
  const std::vector<IkBranches> waypoints{branches({joints(0.1, 0, 0), joints(3, 0, 0)}),
                                          branches({joints(1.1, 0, 0), joints(3.1, 0, 0)})};
  EXPECT_EQ(choose(joints(0, 0, 0), waypoints)->front(), joints(0.1, 0, 0));
  EXPECT_EQ(choose(joints(0, 0, 0), waypoints, {.first_move = kFree})->front(), joints(3, 0, 0));
}

TEST(MinMax, StaysInOneBranchWhenToldTo) {
  const std::vector<IkBranches> waypoints{
      labelled({{"up", joints(0, 0, 0)}, {"down", joints(0.5, 0, 0)}}),
      labelled({{"up", joints(3, 0, 0)}, {"down", joints(0.6, 0, 0)}}),
      labelled({{"up", joints(0.7, 0, 0)}, {"down", joints(2, 0, 0)}})};
  EXPECT_EQ(choose(joints(0, 0, 0), waypoints)->back(), joints(0.7, 0, 0));
  EXPECT_EQ(choose(joints(0, 0, 0), waypoints, {.one_branch = true})->back(), joints(2, 0, 0));
}

TEST(MinMax, NamesTheWaypointAtWhichEveryBranchEnds) {
  const auto both = labelled({{"up", joints(0, 0, 0)}, {"down", joints(0.5, 0, 0)}});
  const auto down = labelled({{"down", joints(0, 0, 0)}}), up = labelled({{"up", joints(0, 0, 0)}});
  EXPECT_EQ(choose(joints(0, 0, 0), {both, down, up, both}, {.one_branch = true}).error().text,
            "waypoint 3 of 4: 1 branch within limits, not to be reached from waypoint 2 in one "
            "branch");
}

TEST(MinMax, NamesTheWaypointThatOnlyAJumpReaches) {
  const auto near = branches({joints(0, 0, 0)});
  const auto far = branches({joints(1, 0, 0), joints(0, -2, 0)});
  EXPECT_EQ(
      choose(joints(0, 0, 0), {near, far, near}, {.jump_limit = 30 * kRadPerDegree}).error().text,
      "waypoint 2 of 3: 2 branches within limits, not to be reached from waypoint 1 by turns "
      "of at most 30 deg");
  EXPECT_EQ(choose(joints(0, 0, 0), {far, near}, {.jump_limit = 30 * kRadPerDegree}).error().text,
            "waypoint 1 of 2: 2 branches within limits, not to be reached from the start by turns "
            "of at most 30 deg");
  EXPECT_TRUE(
      choose(joints(0, 0, 0), {far}, {.first_move = kFree, .jump_limit = 30 * kRadPerDegree}));
  EXPECT_TRUE(
      choose(joints(0, 0, 0), {branches({joints(0, 0, 9)})}, {.jump_limit = 30 * kRadPerDegree}))
      << "a slide does not turn";
}

TEST(MinMax, AWholeTurnThatTheLimitsForceIsAJump) {
  // From 3.9 to 4.1 rad, which is beyond the limit: back round to -2.18.
  const std::vector<IkBranches> waypoints{branches({joints(3.9 - 2 * M_PI, 0, 0)}),
                                          branches({joints(4.1 - 2 * M_PI, 0, 0)})};
  EXPECT_NEAR(choose(joints(3.8, 0, 0), waypoints)->back()[0], 4.1 - 2 * M_PI, 1e-12);
  EXPECT_EQ(choose(joints(3.8, 0, 0), waypoints, {.jump_limit = 90 * kRadPerDegree}).error().text,
            "waypoint 2 of 2: 1 branch within limits, not to be reached from waypoint 1 by turns "
            "of at most 90 deg");
}

TEST(MinMax, NamesTheWaypointWithoutABranchWithinLimits) {
  const auto good = branches({joints(0, 0, 0)});
  const auto bad = branches({joints(0, 3.1, 0), joints(0, 0, 11)});
  EXPECT_EQ(choose(joints(0, 0, 0), {good, bad, good}).error().text,
            "waypoint 2 of 3: 2 branches, none within limits");
  EXPECT_EQ(choose(joints(0, 0, 0), {good, branches({})}).error().text,
            "waypoint 2 of 2: no branch");
}

}  // namespace
}  // namespace armature::select::minmax
