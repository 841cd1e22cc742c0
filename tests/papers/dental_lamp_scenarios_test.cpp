// SPDX-License-Identifier: Apache-2.0
// Two thousand mouths: the paper's way from P1 by P2 to P3 against the arc, both in two seconds.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <optional>
#include <random>
#include <vector>

#include "armature/robot/kinematics/kinematics.hpp"
#include "armature/values/angles.hpp"
#include "paper_lamp.hpp"

namespace armature::paper {
namespace {

using Eigen::Vector3d;

constexpr int kScenarios = 2000;
constexpr unsigned kScenarioSeed = 20260101;
constexpr double kWay_s = 2;  // from P1 to P3
constexpr int kChecks = 100;  // of a plan, between its samples too

/// A mouth, and where the lamp comes from (P1) and goes to (P3), both at the lamp's distance.
struct Scenario {
  Vector3d mouth;
  ToolPose P1, P3;
};

class Scenarios {
 public:
  /// The example's mouth +-300, 300, 150 mm; both directions anywhere within 35 degrees of the
  /// example's last one.
  Scenario next() {
    Scenario scenario;
    scenario.mouth = paper_lamp().mouth +
                     Vector3d{0.3 * even_(random_), 0.3 * even_(random_), 0.15 * even_(random_)};
    scenario.P1 = looking(scenario.mouth);
    scenario.P3 = looking(scenario.mouth);
    return scenario;
  }

 private:
  ToolPose looking(const Vector3d& mouth) {
    const Vector3d middle = direction_of(paper_lamp().P3);
    const double lowest = std::cos(35 * kRadPerDegree);
    const double cosine = lowest + (1 - lowest) * 0.5 * (1 + even_(random_));
    const Vector3d aside = middle.unitOrthogonal();
    const Vector3d round = Eigen::AngleAxisd{M_PI * even_(random_), middle} * aside;
    const Vector3d u = cosine * middle + std::sqrt(1 - cosine * cosine) * round;
    return {mouth - LampExample::kDistance_m * u, Direction{u}};
  }

  std::mt19937_64 random_{kScenarioSeed};
  std::uniform_real_distribution<double> even_{-1, 1};
};

/// The paper's branch, whatever the joint limits, on the turn that is nearest to `near`.
std::optional<JointVector> reached(const ToolPose& pose, const JointVector& near) {
  for (const IkBranch& branch : paper_lamp().branches(pose.position, direction_of(pose))) {
    if (branch.label != "tilt0/balance0/elbow0") continue;
    JointVector q = branch.q;
    for (int i = 0; i < q.size(); ++i) q[i] = near[i] + std::remainder(q[i] - near[i], 2 * M_PI);
    return q;
  }
  return std::nullopt;
}

/// Errors over the whole way, and the largest acceleration of any joint.
struct Outcome {
  double distance_mm = 0, aim_deg = 0, acceleration = 0;
};

Outcome outcome_of(const Trajectory& plan, const Vector3d& mouth) {
  Outcome outcome{.acceleration = peaks_of(plan).acceleration};
  for (int i = 0; i <= kChecks; ++i) {
    const JointVector q = plan.at(plan.start + seconds(kWay_s * i / kChecks)).q;
    const Eigen::Isometry3d pose = forward_kinematics(paper_lamp().model(), q);
    const Vector3d to_mouth = mouth - pose.translation();
    const Vector3d light = pose.linear().col(0);
    outcome.distance_mm =
        std::max(outcome.distance_mm, 1e3 * std::abs(to_mouth.norm() - LampExample::kDistance_m));
    outcome.aim_deg =
        std::max(outcome.aim_deg,
                 std::atan2(light.cross(to_mouth).norm(), light.dot(to_mouth)) / kRadPerDegree);
  }
  return outcome;
}

/// Two joint quintics of a second each by P2, where the lamp stands: the paper's.
Outcome by_paper(const Scenario& scenario, const JointVector& q1, const JointVector& q3) {
  const Vector3d middle = (direction_of(scenario.P1) + direction_of(scenario.P3)).normalized();
  const auto q2 =
      reached({scenario.mouth - LampExample::kDistance_m * middle, Direction{middle}}, q1);
  const JointSegment first{{0, 1}, {q1, q2.value()}, true, 0.5 * kWay_s};
  const JointSegment second{{0, 1}, {q2.value(), q3}, true, 0.5 * kWay_s};
  return outcome_of(paper_lamp().unlimited("trajectory/quintic", {first, second}), scenario.mouth);
}

/// path/mouth_arc and trajectory/quintic_spline, as configs/dental_lamp.yaml has them.
Outcome by_arc(const Scenario& scenario, const JointVector& q1) {
  const auto path = paper_lamp()
                        .path("path/mouth_arc")
                        .plan({.start = scenario.P1, .goal = scenario.P3, .focus = scenario.mouth});
  JointSegment arc{.s = {}, .q = {}, .duration_s = kWay_s};
  for (const PathSample& sample : path->front().samples) {
    arc.s.push_back(sample.s);
    arc.q.push_back(reached(sample.pose, arc.q.empty() ? q1 : arc.q.back()).value());
  }
  EXPECT_EQ(path->size(), 1u) << "an arc from end to end";
  return outcome_of(paper_lamp().unlimited("trajectory/quintic_spline", {arc}), scenario.mouth);
}

/// Of a figure of all outcomes.
struct Spread {
  double median, p95, max;
};
Spread spread_of(const std::vector<Outcome>& outcomes, double Outcome::*figure) {
  std::vector<double> values;
  for (const Outcome& outcome : outcomes) values.push_back(outcome.*figure);
  std::sort(values.begin(), values.end());
  return {values[values.size() / 2], values[values.size() * 95 / 100], values.back()};
}

void print(const char* what, const Spread& s) {
  std::printf("  %-42s median %9.4f  95 %% %9.4f  max %9.4f\n", what, s.median, s.p95, s.max);
}

TEST(DentalLampScenarios, TheArcStaysOnTheMouthInEveryOneOfThemAndThePapersWayDoesNot) {
  Scenarios scenarios;
  std::vector<Outcome> paper, arc;
  std::vector<double> gentler;
  int drawn = 0;
  while (paper.size() < kScenarios) {
    ++drawn;
    const Scenario scenario = scenarios.next();
    const auto q1 = reached(scenario.P1, JointVector::Zero(5));
    const auto q3 = q1 ? reached(scenario.P3, *q1) : q1;
    if (!q3) continue;
    SCOPED_TRACE("seed " + std::to_string(kScenarioSeed) + ", scenario " + std::to_string(drawn));
    paper.push_back(by_paper(scenario, *q1, *q3));
    arc.push_back(by_arc(scenario, *q1));
    gentler.push_back(arc.back().acceleration / paper.back().acceleration);
  }
  std::printf("%d scenarios with both ends in reach of %d drawn, seed %u:\n", kScenarios, drawn,
              kScenarioSeed);
  const Spread paper_mm = spread_of(paper, &Outcome::distance_mm);
  const Spread paper_deg = spread_of(paper, &Outcome::aim_deg);
  const Spread arc_mm = spread_of(arc, &Outcome::distance_mm);
  const Spread arc_deg = spread_of(arc, &Outcome::aim_deg);
  print("paper: distance error [mm]", paper_mm);
  print("paper: direction error [deg]", paper_deg);
  print("arc: distance error [mm]", arc_mm);
  print("arc: direction error [deg]", arc_deg);
  std::sort(gentler.begin(), gentler.end());
  print("arc: peak acceleration / the paper's",
        {gentler[gentler.size() / 2], gentler[gentler.size() * 95 / 100], gentler.back()});
  EXPECT_LT(arc_mm.p95, 0.01);
  EXPECT_LT(arc_deg.p95, 0.0005);
  EXPECT_GT(paper_mm.median, 1000 * arc_mm.median);
  EXPECT_LT(gentler[gentler.size() / 2], 0.65);
}

}  // namespace
}  // namespace armature::paper
