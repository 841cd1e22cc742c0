// SPDX-License-Identifier: Apache-2.0
#include "follow.hpp"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <vector>

#include "recording.hpp"
#include "reference_check.hpp"

namespace armature::test {
namespace {

constexpr double kMoveAt = 12;        // [s] long after the first alignment
constexpr double kAlignedAgain = 5;   // [s] after the patient has come to rest, at most
constexpr double kMaxVelocity = 1.0;  // of configs/dental_lamp.yaml
constexpr double kMaxAcceleration = 2.5;
constexpr double kMaxJerk = 300;  // [rad/s3] jumps above 5e-8 rad, 1.5e-4 rad/s, 0.3 rad/s2 show

std::vector<std::string> settings_of(const PatientMove& move) {
  const std::string scene = "components.scene.params.";
  return {kSimulated,
          fmt::format("{}move_at_s={}", scene, kMoveAt),
          fmt::format("{}move_duration_s={}", scene, move.duration_s),
          fmt::format("{}move_mm={}", scene, move.move_mm),
          fmt::format("{}move_tilt_up_deg={}", scene, move.tilt_up_deg),
          fmt::format("{}move_tilt_side_deg={}", scene, move.tilt_side_deg),
          "components.report.params.expect_move=true"};
}

bool moving_at(const Recording& recording, double time_s) {
  const auto sample = std::ranges::find_if(recording.reference, [&](const auto& reference) {
    return 1e-9 * static_cast<double>(reference.ns) >= time_s;
  });
  return sample != recording.reference.end() && sample->v.cwiseAbs().maxCoeff() > 0.001;
}

void expect_new_goals_while_the_patient_moves_only(const Recording& recording,
                                                   const PatientMove& move,
                                                   const DeploymentRun& run) {
  const double aligned = run.figure("time_to_align_s");
  const double aligned_again = kMoveAt + move.duration_s + run.figure("time_to_realign_s");
  int spliced = 0;
  for (const GoalChange& change : recording.goals) {
    if (change.state != GoalChange::kAccepted || change.time_s <= aligned) continue;
    EXPECT_GT(change.time_s, kMoveAt) << "a new goal while everything is still";
    EXPECT_LT(change.time_s, aligned_again) << "a new goal while everything is still";
    if (moving_at(recording, change.time_s)) ++spliced;
  }
  EXPECT_GE(spliced, move.spliced_goals) << "too few goals to see anything at a splice";
}

void expect_smooth(const Recording& recording) {
  // Every piece of every plan keeps within this jerk, and so must what is between them.
  const ReferenceLimits limits{
      .velocity = kMaxVelocity, .acceleration = kMaxAcceleration, .jerk = recording.greatest_jerk};
  EXPECT_LT(limits.jerk, kMaxJerk) << "a jump could hide";
  EXPECT_GT(static_cast<double>(recording.reference.size()), kMoveAt / limits.period_s);
  EXPECT_EQ(reference_defect(recording.reference, limits).value_or("none"), "none");

  auto broken = recording.reference;
  for (std::size_t k = broken.size() / 2; k < broken.size(); ++k) broken[k].q[0] += 1e-7;
  EXPECT_NE(reference_defect(broken, limits).value_or("none"), "none");
}

}  // namespace

void expect_followed(const PatientMove& move) {
  DeploymentRun run;
  const Recording recording = record_lamp({.settings = settings_of(move)}, run);
  expect_aligned(run);
  SCOPED_TRACE(run.text());
  EXPECT_LE(run.figure("time_to_realign_s"), kAlignedAgain);
  expect_new_goals_while_the_patient_moves_only(recording, move, run);
  expect_smooth(recording);
}

}  // namespace armature::test
