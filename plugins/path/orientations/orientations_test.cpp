// SPDX-License-Identifier: Apache-2.0
// path/orientations: 1. the laws of a path with each interpolator, 2. through every key in one
// segment, no sample farther than a step, 3. as smooth as its curves, 4. the short way round,
// 5. directions, 6. repeated and impossible key poses.
#include "orientations.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "armature/kinds/path/contract.hpp"

namespace armature::path::orientations {
namespace {

using Eigen::Quaterniond;
using Eigen::Vector3d;

using Interpolator = Parameters::Interpolator;
using enum Parameters::Interpolator;

Expected<Path> plan(const PathRequest& request, const Parameters& parameters = {}) {
  return Orientations{parameters}.plan(request);
}

PathSubject subject(const std::string& name, Interpolator interpolator) {
  return {name, std::make_shared<Orientations>(Parameters{.interpolator = interpolator})};
}

INSTANTIATE_TEST_SUITE_P(Orientations, PathLaws,
                         testing::Values(subject("slerp", slerp), subject("squad", squad),
                                         subject("rotvec_bspline", rotvec_bspline),
                                         subject("chart_bspline", chart_bspline)),
                         testing::PrintToStringParamName());

const Quaterniond& rotation(const PathSample& sample) {
  return std::get<Quaterniond>(sample.pose.orientation);
}
const Vector3d& direction(const PathSample& sample) {
  return std::get<Direction>(sample.pose.orientation).unit;
}

ToolPose turned(double angle, const Vector3d& axis, const Vector3d& position) {
  return {position, Quaterniond{Eigen::AngleAxisd{angle, axis.normalized()}}};
}

/// Three bores, one after the other: they lie and lean differently.
PathRequest three_bores() {
  return {.start = turned(0.2, {0, 0, 1}, {0.4, 0, 0.5}),
          .goal = turned(1.1, {1, 0.4, 0}, {0.45, 0.12, 0.46}),
          .through = {turned(0.7, {1, 0, 0.2}, {0.42, 0.05, 0.5}),
                      turned(0.5, {0, 1, 0}, {0.5, 0.06, 0.48})}};
}

TEST(Orientations, OneSegmentWithoutAStopGoesThroughEveryKeyPose) {
  for (const auto interpolator : {slerp, squad, rotvec_bspline, chart_bspline}) {
    const PathRequest request = three_bores();
    const auto path = plan(request, {.interpolator = interpolator});
    ASSERT_TRUE(path) << path.error().text;
    ASSERT_EQ(path->size(), 1u);
    const PathSegment& segment = path->front();
    EXPECT_EQ(segment.space, PathSegment::Space::cartesian);
    EXPECT_TRUE(segment.stop_at_end);
    EXPECT_FALSE(segment.duration_s);
    std::size_t found = 0;
    for (const PathSample& sample : segment.samples) {
      if (found == 2 || sample.pose.position != request.through[found].position) continue;
      const auto& key = std::get<Quaterniond>(request.through[found].orientation);
      EXPECT_LE((rotation(sample).coeffs() - key.coeffs()).norm(), 1e-15);
      ++found;
    }
    EXPECT_EQ(found, 2u);
  }
}

TEST(Orientations, NeighboursAreAtMostAStepApart) {
  for (const auto interpolator : {slerp, squad, rotvec_bspline, chart_bspline}) {
    const auto path =
        plan(three_bores(),
             {.interpolator = interpolator, .step_rad = 1.5 * M_PI / 180, .step_m = 0.004});
    const auto& samples = path->front().samples;
    double turn = 0, way = 0;
    for (std::size_t i = 1; i < samples.size(); ++i) {
      turn = std::max(turn, rotation(samples[i]).angularDistance(rotation(samples[i - 1])));
      way = std::max(way, (samples[i].pose.position - samples[i - 1].pose.position).norm());
    }
    EXPECT_LE(turn, 1.5 * M_PI / 180 * (1 + 1e-5));
    EXPECT_LE(way, 0.004 * (1 + 1e-5));
    EXPECT_GE(std::max(turn / (1.5 * M_PI / 180), way / 0.004), 0.8) << "more samples than needed";
  }
}

/// Second differences of all samples on both sides of the second key pose, by s.
TEST(Orientations, BendsThroughAKeyPoseWithoutAStepInItsSecondDerivative) {
  const PathRequest request = three_bores();
  const auto path = plan(request, {.step_rad = 0.05 * M_PI / 180, .step_m = 0.0001});
  ASSERT_TRUE(path) << path.error().text;
  const auto& samples = path->front().samples;
  const auto key = std::ranges::find_if(samples, [&](const PathSample& sample) {
    return sample.pose.position == request.through[1].position;
  });
  ASSERT_NE(key, samples.end());
  const auto second = [](auto middle) {
    const double before = middle->s - (middle - 1)->s, behind = (middle + 1)->s - middle->s;
    const Vector3d slope_before = (middle->pose.position - (middle - 1)->pose.position) / before,
                   slope_behind = ((middle + 1)->pose.position - middle->pose.position) / behind;
    const auto rate = [](auto a, auto b) {
      const Eigen::AngleAxisd turn{rotation(*b) * rotation(*a).conjugate()};
      return Vector3d{turn.angle() * turn.axis() / (b->s - a->s)};
    };
    const Vector3d omega_before = rate(middle - 1, middle), omega_behind = rate(middle, middle + 1);
    return std::pair{Vector3d{2 * (slope_behind - slope_before) / (before + behind)},
                     Vector3d{2 * (omega_behind - omega_before) / (before + behind)}};
  };
  const auto before = second(key - 2), behind = second(key + 2);
  EXPECT_GE(before.first.norm(), 1);  // [m]: it does bend here
  EXPECT_GE(before.second.norm(), 10);
  EXPECT_LE((behind.first - before.first).norm(), 0.05 * before.first.norm());
  EXPECT_LE((behind.second - before.second).norm(), 0.05 * before.second.norm());
}

TEST(Orientations, KeysOnOnePlaceAreTurnedThroughAtOneSpeed) {
  PathRequest request = three_bores();
  for (ToolPose& key : request.through) key.position = request.start.position;
  request.goal.position = request.start.position;
  const auto path = plan(request, {.interpolator = slerp});
  ASSERT_TRUE(path) << path.error().text;
  const auto& samples = path->front().samples;
  const double first = rotation(samples[1]).angularDistance(rotation(samples[0])) / samples[1].s;
  for (std::size_t i = 1; i < samples.size(); ++i) {
    const double turn = rotation(samples[i]).angularDistance(rotation(samples[i - 1]));
    EXPECT_NEAR(turn / (samples[i].s - samples[i - 1].s), first, 1e-6);
    EXPECT_LE((samples[i].pose.position - request.start.position).norm(), 1e-15);
  }
}

TEST(Orientations, AcrossHalfATurnOnlyTheRotationVectorsGoTheLongWay) {
  const auto turn = [](Interpolator interpolator) {
    const auto path = plan(
        {.start = turned(3.1, {0, 0, 1}, {0, 0, 0}), .goal = turned(3.3, {0, 0, 1}, {0.1, 0, 0})},
        {.interpolator = interpolator});
    if (!path) return -1.0;
    double total = 0;
    const auto& samples = path->front().samples;
    for (std::size_t i = 1; i < samples.size(); ++i) {
      total += rotation(samples[i]).angularDistance(rotation(samples[i - 1]));
    }
    return total;
  };
  EXPECT_NEAR(turn(slerp), 0.2, 1e-9);
  EXPECT_NEAR(turn(squad), 0.2, 1e-9);
  EXPECT_NEAR(turn(chart_bspline), 0.2, 1e-9);
  EXPECT_NEAR(turn(rotvec_bspline), 2 * M_PI - 0.2, 1e-9);
}

TEST(Orientations, DirectionsGoOnGreatCirclesBetweenTheirBlends) {
  const PathRequest request{.start = {{0, 0, 0}, Direction{{1, 0, 0}}},
                            .goal = {{0, 0, 0}, Direction{{0, 0, 1}}},
                            .through = {{{0, 0, 0}, Direction{{0, 1, 0}}}}};
  const auto path = plan(request);
  ASSERT_TRUE(path) << path.error().text;
  for (const PathSample& sample : path->front().samples) {
    if (sample.s <= 0.25) {
      EXPECT_NEAR(direction(sample).z(), 0, 1e-12);
    }
    if (sample.s >= 0.75) {
      EXPECT_NEAR(direction(sample).x(), 0, 1e-12);
    }
    if (sample.s == 0.5) {
      EXPECT_EQ(direction(sample), Vector3d::UnitY());
    }
  }
}

TEST(Orientations, AKeyPoseThatRepeatsTheOneBeforeChangesNothing) {
  const PathRequest request = three_bores();
  PathRequest repeated = request;
  repeated.through = {request.start, request.through[0], request.through[0], request.through[1],
                      request.goal};
  const auto path = plan(request), same = plan(repeated);
  ASSERT_TRUE(path && same);
  ASSERT_EQ(path->front().samples.size(), same->front().samples.size());
  for (std::size_t i = 0; i < path->front().samples.size(); ++i) {
    EXPECT_EQ(path->front().samples[i].pose.position, same->front().samples[i].pose.position);
  }
}

TEST(Orientations, AKeyPoseWhereTheArmNearlyStandsMakesNoCorner) {
  PathRequest request = three_bores();
  const auto path = plan(request);
  const Vector3d off{3e-7, -4e-7, 2e-7};
  request.through.insert(request.through.begin(), request.start);
  request.through.front().position += off;
  request.through.push_back(request.goal);
  request.through.back().position += off;
  const auto same = plan(request);
  ASSERT_TRUE(path && same);
  ASSERT_EQ(path->front().samples.size(), same->front().samples.size());
  EXPECT_EQ(same->front().samples.front().pose.position, request.start.position);
  EXPECT_EQ(same->front().samples.back().pose.position, request.goal.position);
}

/// 1e-8 rad of where the arm stands are no turn that deserves half of the time.
TEST(Orientations, ATurnByRoundingHasNoWeight) {
  const PathRequest request{.start = turned(1e-8, {0, 0, 1}, {0, 0, 0}),
                            .goal = turned(0, {0, 0, 1}, {0.2, 0.1, 0}),
                            .through = {turned(0, {0, 0, 1}, {0.1, 0, 0})}};
  const auto path = plan(request);
  ASSERT_TRUE(path) << path.error().text;
  const auto& samples = path->front().samples;
  const double to_key = 0.1 / (0.1 + std::hypot(0.1, 0.1));
  const auto key = std::ranges::find_if(samples, [](const PathSample& sample) {
    return sample.pose.position == Vector3d{0.1, 0, 0};
  });
  ASSERT_NE(key, samples.end());
  EXPECT_NEAR(key->s, to_key, 1e-5);
}

/// A solver may know other joints for that pose, on the way to which the tool would leave it.
TEST(Orientations, AnArmThatIsAtItsGoalStaysAsItStands) {
  PathRequest request = three_bores();
  request.through = {};
  request.goal = request.start;
  request.goal.position.x() += 1e-9;
  request.start_joints = JointVector::Constant(7, 0.1);
  const auto path = plan(request);
  ASSERT_TRUE(path) << path.error().text;
  ASSERT_EQ(path->size(), 1U);
  ASSERT_EQ(path->front().samples.size(), 1U);
  EXPECT_EQ(path->front().samples.front().joints, request.start_joints);
}

TEST(Orientations, RefusesWhatHasNoWayOrTooManySamples) {
  const auto refusal = [](auto change, const Parameters& parameters = {}) {
    PathRequest request = three_bores();
    change(request);
    const auto path = plan(request, parameters);
    return path ? "a path" : path.error().text;
  };
  EXPECT_EQ(refusal([](auto& r) { r.through[1].orientation = Direction{}; }),
            "start, key poses and goal must all have a rotation, or all a direction");
  EXPECT_EQ(refusal([](auto& r) {
              r.start.orientation = Direction{{1, 0, 0}};
              r.through = {};
              r.goal.orientation = Direction{{-1, 0, 0}};
            }),
            "a direction is opposite to the one before: antipodal, any way is as short");
  EXPECT_EQ(refusal([](auto& r) {
              r.through[1] = turned(1, {0, 0, 1}, {0, 0, 0});
              r.goal = turned(1 - M_PI, {0, 0, 1}, {0, 0, 0});
            }),
            "keys 3 and 4 are antipodal: half a turn apart, either way is as short (key 1 is the "
            "start; repeated poses are not counted)");
  EXPECT_EQ(refusal(
                [](auto& r) {
                  r.goal = turned(M_PI, {0, 1, 0}, {0, 0, 0});
                },
                {.interpolator = rotvec_bspline}),
            "key 4 is half a turn: its rotation vector has two signs (key 1 is the start; repeated "
            "poses are not counted)");
  EXPECT_EQ(refusal([](auto& r) { r.goal.position.x() = 1e6; }),
            "the path would have more than 50000 samples of 2 mm and 0.5 degrees");
  EXPECT_NE(refusal([](auto& r) { r.goal.position.x() = 1e300; }), "a path");
}

}  // namespace
}  // namespace armature::path::orientations
