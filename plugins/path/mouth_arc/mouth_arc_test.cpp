// SPDX-License-Identifier: Apache-2.0
#include "mouth_arc.hpp"

#include <gtest/gtest.h>

#include <random>

#include "armature/kinds/path/contract.hpp"

namespace armature::path::mouth_arc {
namespace {

using Eigen::Vector3d;
const Vector3d kMouth{1.55, 0, 0.45};

ToolPose looking_at_mouth_from(const Vector3d& outward, double distance) {
  return {kMouth + distance * outward.normalized(), Direction{-outward.normalized()}};
}

Expected<Path> plan(const ToolPose& start, const ToolPose& goal,
                    std::optional<Vector3d> focus = kMouth) {
  return MouthArc{Parameters{}}.plan({.start = start, .goal = goal, .focus = focus});
}

const Vector3d& direction(const PathSample& sample) {
  return std::get<Direction>(sample.pose.orientation).unit;
}

double angle(const Vector3d& a, const Vector3d& b) {
  return std::atan2(a.cross(b).norm(), a.dot(b));
}

INSTANTIATE_TEST_SUITE_P(MouthArc, PathLaws,
                         testing::Values(PathSubject{"mouth_arc",
                                                     std::make_shared<MouthArc>(Parameters{})}),
                         testing::PrintToStringParamName());

TEST(MouthArc, EverySampleOfTheArcLooksAtTheMouthFromTheSameDistance) {
  SCOPED_TRACE("seed 3");
  std::mt19937_64 random{3};
  std::normal_distribution<double> normal;
  for (int i = 0; i < 200; ++i) {
    const Vector3d from{normal(random), normal(random), normal(random)};
    const Vector3d to{normal(random), normal(random), normal(random)};
    const auto path = plan(looking_at_mouth_from(from, 0.5), looking_at_mouth_from(to, 0.5));
    ASSERT_TRUE(path);
    ASSERT_EQ(path->size(), 1u);
    const auto& samples = path->front().samples;
    for (const PathSample& sample : samples) {
      const Vector3d to_mouth = kMouth - sample.pose.position;
      EXPECT_NEAR(to_mouth.norm(), 0.5, 1e-12);
      EXPECT_LE(angle(direction(sample), to_mouth), 1e-9);
      EXPECT_NEAR(angle(-to_mouth, from), sample.s * angle(from, to), 1e-6);  // a great circle
    }
    EXPECT_EQ(samples.front().s, 0);
    EXPECT_EQ(samples.back().s, 1);
  }
}

TEST(MouthArc, SamplesAreAtMostAStepApartAndAtLeastEight) {
  const Vector3d from{-1, 0, 0}, to{-std::cos(0.6), std::sin(0.6), 0};
  const auto path = plan(looking_at_mouth_from(from, 0.5), looking_at_mouth_from(to, 0.5));
  EXPECT_EQ(path->front().samples.size(), 70u);  // 34.4 degrees in steps of half a degree
  const auto small =
      plan(looking_at_mouth_from({-1, 0, 0}, 0.5), looking_at_mouth_from({-1, 0.01, 0}, 0.5));
  EXPECT_EQ(small->front().samples.size(), 9u);
}

TEST(MouthArc, FromAfarItComesToTheDistanceFirstAndThenSwings) {
  const ToolPose start{{0.85, 0.1, 0.505}, Direction{{0.8, -0.6, 0}}};
  const ToolPose goal = looking_at_mouth_from({-0.8, 0.5, 0.3}, 0.5);
  const auto path = plan(start, goal);
  ASSERT_EQ(path->size(), 2u);
  const PathSegment &approach = (*path)[0], &arc = (*path)[1];
  EXPECT_EQ(approach.space, PathSegment::Space::joint);
  const Vector3d u1 = (kMouth - start.position).normalized();
  EXPECT_LE((approach.samples.back().pose.position - (kMouth - 0.5 * u1)).norm(), 1e-12);
  EXPECT_LE((direction(approach.samples.back()) - u1).norm(), 1e-12);
  EXPECT_EQ(arc.space, PathSegment::Space::cartesian);
  EXPECT_LE((arc.samples.front().pose.position - approach.samples.back().pose.position).norm(),
            1e-12);
  EXPECT_EQ(arc.samples.back().pose.position, goal.position);
}

TEST(MouthArc, ASmallCorrectionOfDistanceAimAndSideIsOneSegment) {
  const ToolPose start{{1.06, 0.01, 0.46}, Direction{Vector3d{1, 0.05, 0.02}.normalized()}};
  const ToolPose goal = looking_at_mouth_from({-0.95, 0.1, 0.1}, 0.5);
  const auto path = plan(start, goal);
  ASSERT_EQ(path->size(), 1u);
  const auto& samples = path->front().samples;
  EXPECT_LE((samples.front().pose.position - start.position).norm(), 1e-12);
  EXPECT_LE((direction(samples.front()) - std::get<Direction>(start.orientation).unit).norm(),
            1e-12);
  EXPECT_EQ(samples.back().pose.position, goal.position);
  double previous_miss = 1;
  for (const PathSample& sample : samples) {
    const double miss = angle(direction(sample), kMouth - sample.pose.position);
    EXPECT_LT(miss, previous_miss + 1e-12);
    previous_miss = miss;
  }
  EXPECT_LE(previous_miss, 1e-9);
}

TEST(MouthArc, AGoalThatDoesNotLookAtTheMouthIsStillMetExactly) {
  ToolPose goal = looking_at_mouth_from({-0.9, 0.3, 0.1}, 0.5);
  goal.orientation = Direction{Vector3d{0.9, -0.2, -0.1}.normalized()};
  const auto path = plan(looking_at_mouth_from({-1, 0, 0}, 0.5), goal);
  const auto& samples = path->back().samples;
  const PathSample& before = samples[samples.size() - 2];
  EXPECT_LE(angle(direction(before), std::get<Direction>(goal.orientation).unit), 0.03);
}

TEST(MouthArc, FromTheOppositeSideItSwingsOverTheTop) {
  const auto path =
      plan(looking_at_mouth_from({-1, 0, 0}, 0.5), looking_at_mouth_from({1, 0, 0}, 0.5));
  const auto& samples = path->front().samples;
  const Vector3d middle = samples[samples.size() / 2].pose.position - kMouth;
  EXPECT_NEAR(middle.z(), 0.5, 1e-3);
  EXPECT_NEAR(middle.y(), 0, 1e-12);
}

TEST(MouthArc, WithoutAPointToLookAtItIsOneJointMove) {
  const ToolPose goal = looking_at_mouth_from({-1, 0, 0}, 0.5);
  const auto path = plan({{0.8, 0, 0.5}, Direction{{1, 0, 0}}}, goal, std::nullopt);
  ASSERT_EQ(path->size(), 1u);
  EXPECT_EQ(path->front().space, PathSegment::Space::joint);
  EXPECT_EQ(path->front().samples.back().pose.position, goal.position);
}

TEST(MouthArc, WhenTheApproachEndsAtTheGoalThereIsNoArc) {
  const auto path =
      plan(looking_at_mouth_from({-1, 0, 0}, 0.8), looking_at_mouth_from({-1, 0, 0}, 0.5));
  ASSERT_EQ(path->size(), 1u);
  EXPECT_EQ(path->front().space, PathSegment::Space::joint);
}

TEST(MouthArc, RefusesWhatCannotBeLookedAt) {
  const ToolPose start = looking_at_mouth_from({-1, 0, 0}, 0.8);
  EXPECT_EQ(plan(start, {kMouth, Direction{{1, 0, 0}}}).error().text,
            "the goal lies on the point to look at");
  EXPECT_EQ(plan(start, {{1.05, 0, 0.45}, Direction{{-1, 0, 0}}}).error().text,
            "the goal looks away from the point to look at");
  EXPECT_EQ(plan(start, {{1, 0, 0.5}, Eigen::Quaterniond::Identity()}).error().text,
            "a goal with a point to look at needs a pointing direction, not a rotation");
}

}  // namespace
}  // namespace armature::path::mouth_arc
