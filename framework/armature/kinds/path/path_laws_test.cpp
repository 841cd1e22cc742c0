// SPDX-License-Identifier: Apache-2.0
// The laws of paths find the planners that break them, and only the laws that are broken.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <functional>
#include <string_view>
#include <utility>
#include <vector>

#include "armature/kinds/path/laws.hpp"

namespace armature {
namespace {

using testing::ElementsAre, testing::IsEmpty;
using Spoil = std::function<void(PathSegment&)>;

PathSegment straight(const PathRequest& request) {
  PathSegment segment;
  segment.samples = {{.s = 0, .pose = request.start}, {.s = 1, .pose = request.goal}};
  return segment;
}

/// From the start to the goal in one segment, which is spoilt.
class Straight : public PathPlanner {
 public:
  explicit Straight(Spoil spoil) : spoil_{std::move(spoil)} {}
  Expected<Path> plan(const PathRequest& request) const override {
    const auto sound = checked(request);
    if (!sound) return tl::unexpected{sound.error()};
    PathSegment segment = straight(*sound);
    spoil_(segment);
    return Path{segment};
  }

 private:
  Spoil spoil_;
};

/// Looks at nothing of what it is asked.
class Credulous : public PathPlanner {
 public:
  Expected<Path> plan(const PathRequest& request) const override { return Path{straight(request)}; }
};

std::vector<std::string_view> broken(const PathSubject& subject) {
  std::vector<std::string_view> names;
  for (const Law<PathSubject>& law : path_laws()) {
    const LawReport report = check_law(law, subject);
    EXPECT_GT(report.questions, 0) << law.name;
    if (!report.kept()) names.push_back(law.name);
  }
  return names;
}

std::vector<std::string_view> broken_when(Spoil spoil) {
  return broken({.name = "spoilt", .planner = std::make_shared<Straight>(std::move(spoil))});
}

TEST(PathLawsThemselves, AreKeptByAStraightLine) {
  EXPECT_THAT(broken_when([](PathSegment&) {}), IsEmpty());
}

TEST(PathLawsThemselves, FindAPathThatIsNotSound) {
  const std::vector<std::pair<std::string_view, Spoil>> spoils{
      {"no rest at the end", [](auto& segment) { segment.stop_at_end = false; }},
      {"1 um beside the goal",
       [](auto& segment) { segment.samples.back().pose.position.x() += 1e-6; }},
      {"1 um beside the start",
       [](auto& segment) { segment.samples.front().pose.position.x() += 1e-6; }},
      {"no end", [](auto& segment) { segment.samples.back().s = 0.9; }},
      {"s does not rise", [](auto& segment) { segment.samples.push_back(segment.samples.back()); }},
      {"no samples", [](auto& segment) { segment.samples.clear(); }},
      {"no time at all", [](auto& segment) { segment.duration_s = 0; }},
      {"a joint segment from s 0",
       [](auto& segment) { segment.space = PathSegment::Space::joint; }}};
  for (const auto& [name, spoil] : spoils) {
    EXPECT_THAT(
        broken_when(spoil),
        ElementsAre("StartsAtTheStartGoesWithoutAGapAndEndsAtTheGoal",
                    "WithoutAPointToLookAtItPlansDirectionsAndRotationsOrRefusesAll",
                    "AStartThatIsTheGoalIsAPathAllTheSame", "ADirectionThatIsNearlyAUnitIsMadeOne",
                    "AnAwkwardRequestIsPlannedSoundlyOrRefusedWithAReason"))
        << name;
  }
}

TEST(PathLawsThemselves, FindJointsThatTakeTheToolElsewhereThanItsPose) {
  const auto model = std::make_shared<const RobotModel>(
      load_robot_model(ARMATURE_SOURCE_DIR "/configs/robots/sr1.yaml"));
  const auto at_zero = [&](PathSegment& segment) {
    segment.space = PathSegment::Space::joint;
    segment.samples.erase(segment.samples.begin());
    segment.samples.back().joints = JointVector::Zero(model->dof());
  };
  EXPECT_THAT(broken({.name = "at zero",
                      .planner = std::make_shared<Straight>(at_zero),
                      .along_a_line = false,
                      .model = model}),
              ElementsAre("StartsAtTheStartGoesWithoutAGapAndEndsAtTheGoal",
                          "WithoutAPointToLookAtItPlansDirectionsAndRotationsOrRefusesAll",
                          "AStartThatIsTheGoalIsAPathAllTheSame"));
}

TEST(PathLawsThemselves, FindAPlannerThatRemembers) {
  int calls = 0;
  const auto remembers = [&calls](PathSegment& segment) {
    PathSample between = segment.samples.front();
    between.s = 1.0 / (2 + ++calls);
    segment.samples.insert(segment.samples.begin() + 1, between);
  };
  EXPECT_THAT(broken_when(remembers), ElementsAre("EqualRequestsGiveEqualPaths"));
}

TEST(PathLawsThemselves, FindAPlannerThatAnswersEverything) {
  EXPECT_THAT(broken({.name = "credulous", .planner = std::make_shared<Credulous>()}),
              ElementsAre("KeepsAwayFromForbiddenZonesOrRefusesThem",
                          "ADirectionThatIsNearlyAUnitIsMadeOne",
                          "ARequestThatIsNoneIsRefusedWithItsReason",
                          "KeyPosesAreGoneThroughInTheirOrderOrRefused"));
}

TEST(PathLawsThemselves, WantARefusalOfAPathAlongALineWithoutThePointOfTheLine) {
  EXPECT_THAT(broken({.name = "along a line",
                      .planner = std::make_shared<Straight>([](PathSegment&) {}),
                      .along_a_line = true}),
              ElementsAre("WithoutAPointToLookAtItPlansDirectionsAndRotationsOrRefusesAll"));
}

}  // namespace
}  // namespace armature
