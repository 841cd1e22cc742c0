// SPDX-License-Identifier: Apache-2.0
// The straight way of a needle: 1. stand-off, entry, target on one line, 2. from the line only
// along the line, 3. away from forbidden zones, 4. what is refused.
#include "needle_path.hpp"

#include <gtest/gtest.h>

#include "armature/kinds/path/contract.hpp"
#include "armature/kinds/path/random_poses.hpp"

namespace armature::path::needle {
namespace {

using Eigen::Vector3d;

class NeedlePaths : public testing::TestWithParam<PathSubject> {
 protected:
  const PathPlanner& planner() const { return *GetParam().planner; }
  /// From somewhere outside to 60 mm behind the entry.
  PathRequest insertion() {
    along_ = random_.unit();
    entry_ = random_.unit();
    return {.start = {entry_ - 0.3 * along_, Direction{random_.unit()}},
            .goal = {entry_ + 0.06 * along_, Direction{along_}},
            .focus = entry_};
  }
  static void expect_sound(const Path& path, const PathRequest& request) {
    LawCheck check;
    check_sound(path, request, check);
    expect_kept(check.report());
  }

  RandomPoses random_{17};
  Vector3d along_, entry_;
};
INSTANTIATE_TEST_SUITE_P(Needle, NeedlePaths,
                         testing::Values(PathSubject{"needle",
                                                     std::make_shared<NeedlePath>(Parameters{})}));
INSTANTIATE_TEST_SUITE_P(Needle, PathLaws,
                         testing::Values(PathSubject{
                             .name = "needle",
                             .planner = std::make_shared<NeedlePath>(Parameters{}),
                             .along_a_line = true}));

TEST_P(NeedlePaths, GoToTheStandOffStopAtTheEntryAndEndAtTheTargetOnOneLine) {
  SCOPED_TRACE("seed 17");
  for (int i = 0; i < 200; ++i) {
    const PathRequest request = insertion();
    const auto path = planner().plan(request);
    ASSERT_TRUE(path) << path.error().text;
    expect_sound(*path, request);
    ASSERT_EQ(path->size(), 3u);
    EXPECT_EQ((*path)[0].space, PathSegment::Space::joint);
    for (const PathSegment& segment : *path) EXPECT_TRUE(segment.stop_at_end);
    EXPECT_LT(((*path)[0].samples.back().pose.position - (entry_ - 0.05 * along_)).norm(), 1e-12);
    EXPECT_LT(((*path)[1].samples.back().pose.position - entry_).norm(), 1e-12);
    for (const PathSegment& segment : {(*path)[1], (*path)[2]}) {
      EXPECT_EQ(segment.space, PathSegment::Space::cartesian);
      for (std::size_t k = 0; k < segment.samples.size(); ++k) {
        const Vector3d at = segment.samples[k].pose.position;
        EXPECT_LT((at - entry_).cross(along_).norm(), 1e-12);
        EXPECT_FALSE(segment.samples[k].redundancy);
        if (k == 0) continue;
        EXPECT_LE((at - segment.samples[k - 1].pose.position).norm(), 0.001 + 1e-12);
      }
    }
  }
}

TEST_P(NeedlePaths, AFullRotationIsKeptAndItsZIsTheNeedle) {
  PathRequest request = insertion();
  Eigen::Matrix3d R;
  R << along_.unitOrthogonal(), along_.cross(along_.unitOrthogonal()), along_;
  const Eigen::Quaterniond rotation{R};
  request.goal.orientation = rotation;
  request.start.orientation = random_.rotation();
  const auto path = planner().plan(request);
  ASSERT_TRUE(path) << path.error().text;
  expect_sound(*path, request);
  for (const PathSample& sample : path->back().samples) {
    EXPECT_EQ(std::get<Eigen::Quaterniond>(sample.pose.orientation).coeffs(), rotation.coeffs());
  }
}

TEST_P(NeedlePaths, FromTheLineTheyGoNowhereElseInAndOut) {
  const PathRequest in = insertion();
  PathRequest out{
      .start = in.goal, .goal = {entry_ - 0.05 * along_, Direction{along_}}, .focus = entry_};
  const auto back = planner().plan(out);
  ASSERT_TRUE(back) << back.error().text;
  expect_sound(*back, out);
  ASSERT_EQ(back->size(), 2u) << "to the entry, and out of it";
  for (const PathSegment& segment : *back) EXPECT_EQ(segment.space, PathSegment::Space::cartesian);
  out.start = {entry_ + 0.02 * along_, Direction{along_}};
  out.goal = in.goal;
  const auto on = planner().plan(out);
  ASSERT_TRUE(on);
  expect_sound(*on, out);
  EXPECT_EQ(on->size(), 1u);
}

TEST_P(NeedlePaths, ASlidingNeedleIsToldItsDepth) {
  const NeedlePath sliding{{.needle_at_entry = 0.1}};
  const PathRequest request = insertion();
  const auto path = sliding.plan(request);
  ASSERT_TRUE(path) << path.error().text;
  EXPECT_NEAR(path->front().samples.back().redundancy->value, 0.05, 1e-12);
  for (const PathSample& sample : path->back().samples) {
    EXPECT_NEAR(sample.redundancy->value, 0.1 + along_.dot(sample.pose.position - entry_), 1e-12);
  }
  EXPECT_EQ(NeedlePath{{.needle_at_entry = 0.03}}.plan(request).error().text,
            "the needle starts 50 mm before the entry and would have to be 20 mm shorter than "
            "nothing (needle_at_entry_m)");
}

TEST_P(NeedlePaths, AZoneThatIsTooNearIsNamedWithItsDistance) {
  PathRequest request{.start = {{0, 0, 0.3}, Direction{{1, 0, 0}}},
                      .goal = {{0, 0, -0.08}, Direction{{0, 0, -1}}},
                      .focus = Vector3d{0, 0, 0}};
  // 1.5 mm are left: 4 mm of radius and 1 mm of needle beside a line that is 6.5 mm away.
  request.forbidden = {{"far", {0.1, 0, 0}, {0.1, 0, -0.1}, 0.004},
                       {"artery", {0.0065, -1, -0.04}, {0.0065, 1, -0.04}, 0.004}};
  EXPECT_EQ(planner().plan(request).error().text,
            "the needle leaves 1.50 mm to 'artery', 2 mm are required (margin_mm)");
  EXPECT_TRUE(NeedlePath{{.margin = 0.0014}}.plan(request));
  request.forbidden[1].from.z() = request.forbidden[1].to.z() = -0.09;
  EXPECT_TRUE(planner().plan(request)) << "behind the target, 10 mm and a bit";
  request.forbidden[1].from.z() = request.forbidden[1].to.z() = 0.03;
  EXPECT_FALSE(planner().plan(request)) << "between stand-off and entry";
}

TEST_P(NeedlePaths, AHeadIsEnteredOnTheLineAndNotAtTheStandOff) {
  PathRequest request{.start = {{0, 0, 0.3}, Direction{{1, 0, 0}}},
                      .goal = {{0, 0, -0.06}, Direction{{0, 0, -1}}},
                      .focus = Vector3d{0, 0, 0}};
  // The skin is 1 mm before the entry.
  request.forbidden = {{"head", {0, 0, -0.079}, {0, 0, -0.079}, 0.08, true}};
  const auto path = planner().plan(request);
  ASSERT_TRUE(path) << path.error().text;
  expect_sound(*path, request);
  request.start.position = {0.3, 0, -0.1};
  request.goal = {{0, 0, 0.06}, Direction{{0, 0, 1}}};
  request.forbidden[0].from.z() = request.forbidden[0].to.z() = -0.04;
  EXPECT_EQ(planner().plan(request).error().text,
            "the needle leaves -71.00 mm to 'head' at its stand-off, 50 mm before the entry, 2 mm "
            "are required (margin_mm): is the entry on the side that it comes from, and "
            "stand_off_mm large enough?");
  request.start = {{0, 0, 0.01}, Direction{{0, 0, 1}}};
  EXPECT_TRUE(planner().plan(request)) << "on its line it goes on, and comes out";
  request.forbidden[0].tool_enters = false;
  EXPECT_FALSE(planner().plan(request)) << "what is entered by nothing";
}

TEST_P(NeedlePaths, WhatBelongsToAHeadIsNotPassedThroughBeforeTheEntry) {
  PathRequest request{.start = {{0, 0, 0.3}, Direction{{1, 0, 0}}},
                      .goal = {{0, 0, -0.06}, Direction{{0, 0, -1}}},
                      .focus = Vector3d{0, 0, 0}};
  request.forbidden = {{"head", {0, 0, -0.079}, {0, 0, -0.079}, 0.08, true},
                       {"ear", {0, 0.01, 0.02}, {0, 0.01, 0.02}, 0.008, true}};
  EXPECT_EQ(planner().plan(request).error().text,
            "the needle leaves 1.00 mm to 'ear' on its way to the entry, 2.00 mm are required: the "
            "entry is not where it comes in");
  request.forbidden[1].radius_m = 0.006;
  EXPECT_TRUE(planner().plan(request));
  request.forbidden[1] = {"cheek", {0, 0.03, -0.04}, {0, 0.03, -0.04}, 0.052, true};
  EXPECT_TRUE(planner().plan(request)) << "the entry is in it as well";
}

TEST_P(NeedlePaths, AHeadIsNotPassedThroughBeforeTheEntryFromTheLineEither) {
  PathRequest request{.goal = {{0.06, 0, 0}, Direction{{1, 0, 0}}}, .focus = Vector3d{0, 0, 0}};
  request.forbidden = {{"nose", {-0.03, 0, 0}, {-0.03, 0, 0}, 0.01, true}};
  const auto from = [&](double at) {
    request.start = {{at, 0, 0}, Direction{{1, 0, 0}}};
    return planner().plan(request);
  };
  for (const double behind_nose : {-0.05, -0.2}) {
    EXPECT_EQ(from(behind_nose).error().text,
              "the needle leaves -11.00 mm to 'nose' on its way to the entry, 2.00 mm are "
              "required: the entry is not where it comes in");
  }
  EXPECT_FALSE(from(-0.03)) << "in it";
  EXPECT_TRUE(from(-0.015)) << "the nose is behind the tip";
  request.goal.position.x() = -0.25;
  EXPECT_TRUE(from(-0.2)) << "drawn back, away from it";
}

TEST_P(NeedlePaths, ANeedleThatIsTooNearAVesselIsDrawnBackAndGoesNoDeeper) {
  PathRequest request{.start = {{0.06, 0, 0}, Direction{{1, 0, 0}}},
                      .goal = {{-0.05, 0, 0}, Direction{{1, 0, 0}}},
                      .focus = Vector3d{0, 0, 0}};
  // 1.9 mm are left before the tip: 4 mm of radius and 1 mm of needle.
  request.forbidden = {{"ahead", {0.0669, -1, 0}, {0.0669, 1, 0}, 0.004}};
  EXPECT_TRUE(planner().plan(request));
  request.goal.position.x() = 0.061;
  EXPECT_EQ(planner().plan(request).error().text,
            "the needle leaves 0.90 mm to 'ahead', 2 mm are required (margin_mm)");
  request.start.position.x() = 0.02;
  request.forbidden = {{"pierced", {0.01, -1, 0}, {0.01, 1, 0}, 0.004}};
  EXPECT_EQ(planner().plan(request).error().text,
            "the needle leaves -5.00 mm to 'pierced', 2 mm are required (margin_mm)");
  request.goal.position.x() = -0.05;
  EXPECT_TRUE(planner().plan(request));
}

TEST_P(NeedlePaths, WhatWouldHurtIsRefused) {
  const PathRequest good = insertion();
  const auto refusal = [&](auto change) {
    PathRequest bad = good;
    change(bad);
    const auto path = planner().plan(bad);
    return path ? "" : path.error().text;
  };
  EXPECT_EQ(refusal([](auto& r) { r.focus.reset(); }),
            "there is no entry: a goal for a needle names it as the point to look at");
  const Vector3d side = along_.unitOrthogonal();
  EXPECT_EQ(refusal([&](auto& r) { *r.focus += 0.002 * side; }),
            "the needle's line passes the entry at 2.000 mm, 0.1 mm are allowed (on_line_mm)");
  EXPECT_EQ(
      refusal([&](auto& r) { r.start.position = entry_ + 0.02 * along_ + 0.01 * side; }),
      "the tip is 20.0 mm past the entry and 10.0 mm beside the line: it has to be drawn back "
      "first");
  EXPECT_EQ(refusal([&](auto& r) { r.goal.position = entry_ + 60 * along_; }),
            "the way along the line is 60.05 m, more than 50000 steps of 1 mm (step_mm)");
  EXPECT_EQ(refusal([](auto& r) { r.goal.position.x() = NAN; }),
            "the goal's position is not finite");
  EXPECT_EQ(refusal([](auto& r) {
              r.forbidden = {{"vein", {0, 0, 0}, {0, 0, 0}, NAN}};
            }),
            "forbidden zone 'vein' has the radius nan m");
}

}  // namespace
}  // namespace armature::path::needle
