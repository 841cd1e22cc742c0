// SPDX-License-Identifier: Apache-2.0
#include "nearest.hpp"

#include <gtest/gtest.h>

#include <limits>

#include "armature/kinds/select/contract.hpp"

namespace armature::select::nearest {
namespace {

/// Two revolute joints and a slide; the second joint is four times faster than the first, which
/// turns by `turn`.
RobotModel robot(double turn = 4) {
  const auto joint = [](std::string name, Joint::Type type, double limit, double velocity) {
    return Joint{.name = std::move(name),
                 .type = type,
                 .lower = -limit,
                 .upper = limit,
                 .max_velocity = velocity,
                 .max_acceleration = 1};
  };
  return {
      {"crane",
       RobotModel::Convention::standard,
       {joint("turn", Joint::Type::revolute, turn, 1), joint("tilt", Joint::Type::revolute, 3, 4),
        joint("slide", Joint::Type::prismatic, 10, 1)},
       {{"tool", 2, Eigen::Isometry3d::Identity()}},
       FrameId{0},
       {},
       {}}};
}

JointVector joints(double turn, double tilt, double slide) {
  return Eigen::Vector3d{turn, tilt, slide};
}

IkBranches branches(const std::vector<JointVector>& qs) {
  IkBranches result;
  for (const JointVector& q : qs) result.add().q = q;
  return result;
}

Expected<std::vector<JointVector>> choose(const JointVector& start,
                                          const std::vector<IkBranches>& waypoints,
                                          const Parameters& parameters = {}) {
  const RobotModel model = robot();
  return Nearest{model, parameters}.choose(start, waypoints);
}

constexpr Parameters kSum{.nearness = Parameters::Nearness::sum};

SelectSubject subject(const std::string& name, const RobotModel& model,
                      const Parameters& parameters = {}) {
  const auto shared = std::make_shared<const RobotModel>(model);
  return {name, shared, std::make_shared<Nearest>(*shared, parameters)};
}

INSTANTIATE_TEST_SUITE_P(
    Nearest, SelectLaws,
    testing::Values(
        subject("crane_by_slowest_joint", robot()), subject("crane_by_sum", robot(), kSum),
        subject("crane_that_turns_without_limits", robot(std::numeric_limits<double>::infinity())),
        subject("lamp", load_robot_model(ARMATURE_SOURCE_DIR "/configs/robots/dental_lamp.yaml"))),
    testing::PrintToStringParamName());

TEST(Nearest, TakesTheBranchNearestToTheOneBefore) {
  const auto path = choose(joints(0, 0, 0), {branches({joints(1, 0, 0), joints(0.2, 0, 0)}),
                                             branches({joints(0, 0, 0), joints(0.9, 0, 0)})});
  ASSERT_TRUE(path);
  EXPECT_EQ((*path)[0], joints(0.2, 0, 0));
  EXPECT_EQ((*path)[1], joints(0, 0, 0));
}

TEST(Nearest, ATieGoesToTheFirstBranch) {
  const auto path = choose(joints(0, 0, 0), {branches({joints(0.5, 0, 0), joints(-0.5, 0, 0)})});
  EXPECT_EQ(path->front(), joints(0.5, 0, 0));
}

TEST(Nearest, NearIsCountedInTimeOfTheSlowestJointOrInTheSumOfAllTimes) {
  const std::vector<IkBranches> two{branches({joints(0.5, 0, 0), joints(0.4, 1.6, 0.4)})};
  EXPECT_EQ(choose(joints(0, 0, 0), two)->front(), joints(0.4, 1.6, 0.4));
  EXPECT_EQ(choose(joints(0, 0, 0), two, kSum)->front(), joints(0.5, 0, 0));
}

TEST(Nearest, JointsAreUnwoundTowardsTheirNeighbourWithinLimits) {
  const auto path = choose(joints(3.5, 0, 0), {branches({joints(-2.5, 0, 0)})});
  EXPECT_NEAR(path->front()[0], -2.5 + 2 * M_PI, 1e-12);
  const auto other_way = choose(joints(2.5, 0, 0), {branches({joints(-2.2, 0, 0)})});
  EXPECT_NEAR(other_way->front()[0], -2.2, 1e-12);  // + 2 pi would leave the limits
}

TEST(Nearest, ASlideIsNeverUnwound) {
  EXPECT_EQ(choose(joints(0, 0, 9), {branches({joints(0, 0, -3)})})->front()[2], -3);
}

TEST(Nearest, NamesTheWaypointWithoutABranchWithinLimits) {
  const auto good = branches({joints(0, 0, 0)});
  const auto bad = branches({joints(0, 3.1, 0), joints(0, 0, 11)});
  EXPECT_EQ(choose(joints(0, 0, 0), {good, bad, good}).error().text,
            "waypoint 2 of 3: 2 branches, none within limits");
  EXPECT_EQ(choose(joints(0, 0, 0), {good, branches({})}).error().text,
            "waypoint 2 of 2: no branch");
}

}  // namespace
}  // namespace armature::select::nearest
