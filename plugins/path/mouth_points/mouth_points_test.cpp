// SPDX-License-Identifier: Apache-2.0
#include "mouth_points.hpp"

#include <gtest/gtest.h>

#include "armature/kinds/path/contract.hpp"

namespace armature::path::mouth_points {
namespace {

using Eigen::Vector3d;

const Vector3d kMouth{1.9258, 0.0028966, 0.545};
const ToolPose kStart{{1.689, 0, 0.5041}, Direction{{1, 0, 0}}};
const Vector3d kNormal = Vector3d{-0.8185559, 0.5517371, 0.1598514}.normalized();
const ToolPose kGoal{kMouth + 0.5 * kNormal, Direction{-kNormal}};

Expected<Path> plan(const ToolPose& start, const ToolPose& goal,
                    std::optional<Vector3d> focus = kMouth, const Parameters& parameters = {}) {
  return MouthPoints{parameters}.plan({.start = start, .goal = goal, .focus = focus});
}

const ToolPose& end_of(const PathSegment& segment) { return segment.samples.back().pose; }
const Vector3d& direction_of(const ToolPose& pose) {
  return std::get<Direction>(pose.orientation).unit;
}

INSTANTIATE_TEST_SUITE_P(MouthPoints, PathLaws,
                         testing::Values(PathSubject{"mouth_points",
                                                     std::make_shared<MouthPoints>(Parameters{})}),
                         testing::PrintToStringParamName());

TEST(MouthPoints, EveryPointIsAtTheGoalsDistanceAndLooksAtTheMouth) {
  const auto path = plan(kStart, kGoal);
  ASSERT_EQ(path->size(), 3u);
  for (const PathSegment& segment : *path) {
    EXPECT_EQ(segment.space, PathSegment::Space::joint);
    EXPECT_TRUE(segment.stop_at_end);
    EXPECT_EQ(segment.duration_s, 1.0);
    const Vector3d to_mouth = kMouth - end_of(segment).position;
    EXPECT_NEAR(to_mouth.norm(), 0.5, 1e-12);
    EXPECT_LE(direction_of(end_of(segment)).cross(to_mouth).norm(), 1e-9);
  }
}

TEST(MouthPoints, AreThoseOfThePaper) {
  const auto path = plan(kStart, kGoal);
  EXPECT_LE((end_of((*path)[0]).position - Vector3d{1.433130981, -0.003129857, 0.459906407}).norm(),
            1e-7);
  EXPECT_LE((end_of((*path)[1]).position - Vector3d{1.446785748, 0.146206801, 0.542255384}).norm(),
            1e-7);
  EXPECT_LE((end_of((*path)[2]).position - Vector3d{1.516522056, 0.278765134, 0.624925693}).norm(),
            1e-7);
}

TEST(MouthPoints, TheSecondIsHalfWayBetweenTheOthers) {
  const auto path = plan(kStart, kGoal);
  const double first = direction_of(end_of((*path)[0])).dot(direction_of(end_of((*path)[1])));
  const double second = direction_of(end_of((*path)[1])).dot(direction_of(end_of((*path)[2])));
  EXPECT_NEAR(first, second, 1e-12);
  EXPECT_NEAR(std::acos(first) * 180 / M_PI, 19.7015, 1e-4);
}

TEST(MouthPoints, AStartThatIsOneOfThePointsSkipsIt) {
  EXPECT_EQ(plan(end_of(plan(kStart, kGoal)->front()), kGoal)->size(), 2u);
  const ToolPose in_line{kMouth + 0.8 * kNormal, Direction{-kNormal}};
  EXPECT_EQ(plan(in_line, kGoal)->size(), 1u);
  EXPECT_EQ(plan(kGoal, kGoal)->size(), 1u);
}

TEST(MouthPoints, WithoutAPointToLookAtItIsOneMove) {
  const auto path = plan(kStart, kGoal, std::nullopt, {.segment = 2.5});
  ASSERT_EQ(path->size(), 1u);
  EXPECT_EQ(path->front().duration_s, 2.5);
}

TEST(MouthPoints, AZeroSegmentTimeLeavesItToTheLimits) {
  EXPECT_FALSE(plan(kStart, kGoal, kMouth, {.segment = 0})->front().duration_s.has_value());
}

TEST(MouthPoints, RefusesWhatItsFormulasDoNotCover) {
  const ToolPose opposite{kMouth + (kMouth - kStart.position), Direction{{-1, 0, 0}}};
  EXPECT_EQ(plan(kStart, opposite).error().text,
            "the goal is on the opposite side of the point to look at: P2 has no direction");
  EXPECT_EQ(plan({kMouth, Direction{}}, kGoal).error().text,
            "the start lies on the point to look at");
  EXPECT_EQ(plan(kStart, {kMouth, Direction{}}).error().text,
            "the goal lies on the point to look at");
  EXPECT_EQ(plan(kStart, {{1, 0, 0}, Eigen::Quaterniond::Identity()}).error().text,
            "a goal with a point to look at needs a pointing direction, not a rotation");
}

}  // namespace
}  // namespace armature::path::mouth_points
