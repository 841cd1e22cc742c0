// SPDX-License-Identifier: Apache-2.0
#include "armature/kinds/path/contract.hpp"

#include <cmath>
#include <limits>
#include <variant>
#include <vector>

namespace armature {

Eigen::Vector3d PathLaws::random_unit() {
  return Eigen::Vector3d{normal_(random_), normal_(random_), normal_(random_)}.normalized();
}

Eigen::Quaterniond PathLaws::random_rotation() {
  const Eigen::Vector4d any{normal_(random_), normal_(random_), normal_(random_), normal_(random_)};
  return Eigen::Quaterniond{any.normalized()};
}

double PathLaws::between(double low, double high) {
  return std::uniform_real_distribution<double>{low, high}(random_);
}

ToolPose PathLaws::looking_at_focus(double distance, double miss) {
  const Eigen::Vector3d outward = random_unit();
  const Eigen::Vector3d aside = outward.cross(random_unit()).normalized();
  const double angle = between(0, miss);
  return {kFocus + distance * outward,
          Direction{-std::cos(angle) * outward + std::sin(angle) * aside}};
}

double PathLaws::angle_between(const Orientation& a, const Orientation& b) {
  if (a.index() != b.index()) return std::numeric_limits<double>::infinity();
  if (const auto* rotation = std::get_if<Eigen::Quaterniond>(&a)) {
    return rotation->angularDistance(std::get<Eigen::Quaterniond>(b));
  }
  const Eigen::Vector3d &u = std::get<Direction>(a).unit, &v = std::get<Direction>(b).unit;
  return std::atan2(u.cross(v).norm(), u.dot(v));
}

void PathLaws::expect_same(const ToolPose& a, const ToolPose& b) {
  EXPECT_LE((a.position - b.position).norm(), kRounding * (1 + b.position.norm()));
  EXPECT_LE(angle_between(a.orientation, b.orientation), 10 * kRounding);
}

void PathLaws::expect_finite_unit(const ToolPose& pose) {
  EXPECT_TRUE(pose.position.allFinite());
  const auto* direction = std::get_if<Direction>(&pose.orientation);
  const double length =
      direction ? direction->unit.norm() : std::get<Eigen::Quaterniond>(pose.orientation).norm();
  EXPECT_NEAR(length, 1, kRounding);
}

void PathLaws::expect_sound_segment(const PathSegment& segment, const ToolPose& from) {
  const bool cartesian = segment.space == PathSegment::Space::cartesian;
  ASSERT_GE(segment.samples.size(), cartesian ? 2u : 1u);
  if (cartesian) {
    EXPECT_EQ(segment.samples.front().s, 0);
    expect_same(segment.samples.front().pose, from);
  } else {
    EXPECT_GT(segment.samples.front().s, 0) << "a joint segment's start needs no sample";
  }
  EXPECT_EQ(segment.samples.back().s, 1);
  for (std::size_t i = 0; i < segment.samples.size(); ++i) {
    expect_finite_unit(segment.samples[i].pose);
    if (i > 0) {
      EXPECT_GT(segment.samples[i].s, segment.samples[i - 1].s);
    }
  }
}

void PathLaws::expect_passes_key_poses(const Path& path, const PathRequest& request) {
  std::size_t passed = 0;
  for (const PathSegment& segment : path) {
    for (const PathSample& sample : segment.samples) {
      if (passed == request.through.size()) return;
      const ToolPose& key = request.through[passed];
      const double off = (sample.pose.position - key.position).norm();
      if (off <= kRounding * (1 + key.position.norm()) &&
          angle_between(sample.pose.orientation, key.orientation) <= 10 * kRounding) {
        ++passed;
      }
    }
  }
  EXPECT_EQ(passed, request.through.size()) << "key poses that the path goes through";
}

void PathLaws::expect_sound(const Path& path, const PathRequest& request) {
  ASSERT_FALSE(path.empty());
  expect_passes_key_poses(path, request);
  ToolPose last = request.start;
  bool from_stop = true;
  for (const PathSegment& segment : path) {
    expect_sound_segment(segment, last);
    ASSERT_FALSE(segment.samples.empty());
    if (segment.duration_s) {
      EXPECT_TRUE(*segment.duration_s > 0 && std::isfinite(*segment.duration_s));
      EXPECT_TRUE(from_stop && segment.stop_at_end) << "a time law of its own is rest to rest";
    }
    from_stop = segment.stop_at_end;
    last = segment.samples.back().pose;
  }
  EXPECT_TRUE(from_stop) << "the path ends at rest";
  expect_same(last, request.goal);
}

void PathLaws::expect_planned(const PathRequest& request) {
  const auto path = planner().plan(request);
  ASSERT_TRUE(path) << path.error().text;
  expect_sound(*path, request);
}

PathRequest PathLaws::towards_focus(ToolPose start, const ToolPose& goal) const {
  const bool behind = (start.position - kFocus).dot(goal.position - kFocus) < 0;
  if (GetParam().along_a_line && behind) start.position = 2 * kFocus - start.position;
  return {.start = start, .goal = goal, .focus = kFocus};
}

GTEST_ALLOW_UNINSTANTIATED_PARAMETERIZED_TEST(PathLaws);

TEST_P(PathLaws, KeepsAwayFromForbiddenZonesOrRefusesThem) {
  PathRequest request{
      .start = looking_at_focus(0.6, 0.1), .goal = looking_at_focus(0.5, 0), .focus = kFocus};
  request.forbidden = {{"everything", kFocus, kFocus, 10}};
  const auto path = planner().plan(request);
  ASSERT_FALSE(path) << "start, goal and all between are forbidden";
  EXPECT_FALSE(path.error().text.empty());
}

TEST_P(PathLaws, StartsAtTheStartGoesWithoutAGapAndEndsAtTheGoal) {
  SCOPED_TRACE("seed 17");
  for (int i = 0; i < 500; ++i) {
    SCOPED_TRACE(i);
    const double distance = between(0.2, 1);
    const ToolPose anywhere = looking_at_focus(between(0.2, 1), M_PI);
    expect_planned(towards_focus(anywhere, looking_at_focus(distance, miss(0.1))));
    const ToolPose as_far = looking_at_focus(distance + between(-0.1, 0.1), 0.2);
    expect_planned(towards_focus(as_far, looking_at_focus(distance, 0)));
  }
}

TEST_P(PathLaws, WithoutAPointToLookAtItPlansDirectionsAndRotationsOrRefusesAll) {
  SCOPED_TRACE("seed 17");
  if (GetParam().along_a_line) {
    const auto path = planner().plan(
        {.start = looking_at_focus(0.6, 0), .goal = looking_at_focus(0.5, 0), .focus = {}});
    ASSERT_FALSE(path);
    EXPECT_FALSE(path.error().text.empty());
    return;
  }
  for (int i = 0; i < 100; ++i) {
    expect_planned({.start = {random_unit(), Direction{random_unit()}},
                    .goal = {random_unit(), Direction{random_unit()}},
                    .focus = {}});
    expect_planned({.start = {random_unit(), random_rotation()},
                    .goal = {random_unit(), random_rotation()},
                    .focus = {}});
  }
}

TEST_P(PathLaws, AStartThatIsTheGoalIsAPathAllTheSame) {
  SCOPED_TRACE("seed 17");
  for (int i = 0; i < 100; ++i) {
    const ToolPose here = looking_at_focus(between(0.2, 1), i % 2 == 0 ? 0 : miss(1.5));
    expect_planned({.start = here, .goal = here, .focus = kFocus});
    if (!GetParam().along_a_line) expect_planned({.start = here, .goal = here, .focus = {}});
  }
}

TEST_P(PathLaws, EqualRequestsGiveEqualPaths) {
  SCOPED_TRACE("seed 17");
  for (int i = 0; i < 20; ++i) {
    const ToolPose start = looking_at_focus(0.6, 0.3);
    const PathRequest request = towards_focus(start, looking_at_focus(0.5, 0));
    const auto first = planner().plan(request);
    static_cast<void>(planner().plan({.start = request.goal, .goal = request.start, .focus = {}}));
    const auto second = planner().plan(request);
    ASSERT_TRUE(first && second);
    ASSERT_EQ(first->size(), second->size());
    for (std::size_t k = 0; k < first->size(); ++k) {
      const PathSegment &a = (*first)[k], &b = (*second)[k];
      EXPECT_EQ(a.space, b.space);
      EXPECT_EQ(a.stop_at_end, b.stop_at_end);
      EXPECT_EQ(a.duration_s, b.duration_s);
      ASSERT_EQ(a.samples.size(), b.samples.size());
      for (std::size_t n = 0; n < a.samples.size(); ++n) {
        EXPECT_EQ(a.samples[n].s, b.samples[n].s);
        EXPECT_EQ(a.samples[n].pose.position, b.samples[n].pose.position);
        EXPECT_EQ(std::get<Direction>(a.samples[n].pose.orientation).unit,
                  std::get<Direction>(b.samples[n].pose.orientation).unit);
      }
    }
  }
}

TEST_P(PathLaws, ADirectionThatIsNearlyAUnitIsMadeOne) {
  const ToolPose start = looking_at_focus(0.6, 0);
  PathRequest request = towards_focus(start, looking_at_focus(0.5, 0));
  const PathRequest exact = request;
  std::get<Direction>(request.start.orientation).unit *= 1.005;
  std::get<Direction>(request.goal.orientation).unit *= 0.995;
  const auto path = planner().plan(request);
  ASSERT_TRUE(path) << path.error().text;
  expect_sound(*path, exact);
}

TEST_P(PathLaws, ARequestThatIsNoneIsRefusedWithItsReason) {
  const PathRequest good{
      .start = looking_at_focus(0.6, 0), .goal = looking_at_focus(0.5, 0), .focus = kFocus};
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const auto refusal = [&](auto change) {
    std::string reasons;
    for (const bool focused : {true, false}) {
      PathRequest bad = good;
      if (!focused) bad.focus.reset();
      change(bad);
      const auto path = planner().plan(bad);
      EXPECT_FALSE(path);
      if (!path) reasons = path.error().text;
    }
    return reasons;
  };
  EXPECT_EQ(refusal([&](auto& r) { r.start.position.x() = nan; }),
            "the start's position is not finite");
  EXPECT_EQ(refusal([&](auto& r) { r.goal.position.z() = INFINITY; }),
            "the goal's position is not finite");
  EXPECT_EQ(refusal([&](auto& r) {
              r.start.orientation = Direction{{0, 0, 0}};
            }),
            "the start's direction has length 0, not 1");
  EXPECT_EQ(refusal([&](auto& r) {
              r.goal.orientation = Direction{{nan, 0, 0}};
            }),
            "the goal's direction has length nan, not 1");
  EXPECT_EQ(refusal([&](auto& r) {
              r.goal.orientation = Eigen::Quaterniond{2, 0, 0, 0};
            }),
            "the goal's quaternion has length 2, not 1");
  EXPECT_EQ(refusal([&](auto& r) {
              r.through = {good.start, {{0, nan, 0}, Direction{}}};
            }),
            "key pose 2's position is not finite");
  EXPECT_EQ(refusal([&](auto& r) {
              r.focus = Eigen::Vector3d{0, nan, 0};
            }),
            "the point to look at is not finite");
}

TEST_P(PathLaws, KeyPosesAreGoneThroughInTheirOrderOrRefused) {
  SCOPED_TRACE("seed 17");
  for (int i = 0; i < 100; ++i) {
    PathRequest request{.start = {random_unit(), random_rotation()},
                        .goal = {random_unit(), random_rotation()},
                        .focus = {}};
    for (int k = 0; k < 1 + i % 3; ++k) {
      request.through.push_back({random_unit(), random_rotation()});
    }
    const auto path = planner().plan(request);
    if (path) {
      expect_sound(*path, request);
    } else {
      EXPECT_EQ(path.error().text, checked(request).error().text);
    }
  }
}

TEST_P(PathLaws, AnAwkwardRequestIsPlannedSoundlyOrRefusedWithAReason) {
  const ToolPose before{kFocus + Eigen::Vector3d{-0.5, 0, 0}, Direction{{1, 0, 0}}};
  const ToolPose behind{kFocus + Eigen::Vector3d{0.5, 0, 0}, Direction{{-1, 0, 0}}};
  const ToolPose above{kFocus + Eigen::Vector3d{0, 0, 0.5}, Direction{{0, 0, -1}}};
  const ToolPose below{kFocus - Eigen::Vector3d{0, 0, 0.5}, Direction{{0, 0, 1}}};
  const ToolPose on_it{kFocus, Direction{{1, 0, 0}}};
  const ToolPose beside_it{kFocus + Eigen::Vector3d{-1e-7, 0, 0}, Direction{{1, 0, 0}}};
  const ToolPose looking_away{before.position, Direction{{-1, 0, 0}}};
  const ToolPose turned{before.position, Eigen::Quaterniond::Identity()};
  const ToolPose far_away{kFocus + Eigen::Vector3d{-1e6, 0, 0}, Direction{{1, 0, 0}}};
  const std::vector<ToolPose> poses{before,    behind,       above,  below,   on_it,
                                    beside_it, looking_away, turned, far_away};
  for (std::size_t i = 0; i < poses.size(); ++i) {
    for (std::size_t k = 0; k < poses.size(); ++k) {
      SCOPED_TRACE("from " + std::to_string(i) + " to " + std::to_string(k));
      const PathRequest request{.start = poses[i], .goal = poses[k], .focus = kFocus};
      const auto path = planner().plan(request);
      if (path) {
        expect_sound(*path, request);
      } else {
        EXPECT_FALSE(path.error().text.empty());
      }
    }
  }
}
}  // namespace armature
