// SPDX-License-Identifier: Apache-2.0
// The patient moves 50 mm and turns 10 degrees within one second; the lamp follows.
#include <gtest/gtest.h>

#include <algorithm>

#include "recording.hpp"
#include "reference_check.hpp"

namespace armature::test {
namespace {

constexpr double kMoveAt = 12;        // [s] long after the first alignment
constexpr double kMoveEnds = 13;      // [s]
constexpr double kAlignedAgain = 5;   // [s] after the patient has come to rest, at most
constexpr double kMaxVelocity = 1.0;  // of configs/dental_lamp.yaml
constexpr double kMaxAcceleration = 2.5;

const LampStart kPatientMoves{.settings = {kSimulated, "components.scene.params.move_at_s=12",
                                           "components.scene.params.move_duration_s=1",
                                           "components.scene.params.move_mm=[0,50,0]",
                                           "components.scene.params.move_tilt_side_deg=10",
                                           "components.report.params.expect_move=true"}};

std::vector<double> times_of_new_goals(const Recording& recording) {
  std::vector<double> times;
  for (const GoalChange& change : recording.goals) {
    if (change.state == GoalChange::kAccepted) times.push_back(change.time_s);
  }
  return times;
}

bool moving_at(const Recording& recording, double time_s) {
  const auto sample = std::ranges::find_if(recording.reference, [&](const auto& reference) {
    return 1e-9 * static_cast<double>(reference.ns) >= time_s;
  });
  return sample != recording.reference.end() && sample->v.cwiseAbs().maxCoeff() > 0.001;
}

TEST(LampFollows, ThePatientWithoutAJumpAndAlignsAgain) {
  LampRun run;
  const Recording recording = record_lamp(kPatientMoves, run);
  expect_aligned(run);
  SCOPED_TRACE(run.text());
  EXPECT_LE(run.figure("time_to_realign_s"), kAlignedAgain);

  const double aligned = run.figure("time_to_align_s");
  const double aligned_again = kMoveEnds + run.figure("time_to_realign_s");
  int while_moving = 0;
  for (const double time : times_of_new_goals(recording)) {
    EXPECT_FALSE(time > aligned && time < kMoveAt)
        << "a new goal at " << time << " s, all is still";
    EXPECT_LT(time, aligned_again) << "a new goal, all is still";
    if (time > kMoveAt && moving_at(recording, time)) ++while_moving;
  }
  EXPECT_GE(while_moving, 1) << "no goal was spliced into a motion: the check below sees nothing";

  // Every piece of every plan keeps within this jerk, and so must what is between them.
  const ReferenceLimits limits{
      .velocity = kMaxVelocity, .acceleration = kMaxAcceleration, .jerk = recording.greatest_jerk};
  EXPECT_LT(limits.jerk, 200) << "the limits of a jump become loose";
  EXPECT_GT(recording.reference.size(), 14'000U);
  EXPECT_EQ(reference_defect(recording.reference, limits).value_or("none"), "none");
}

}  // namespace
}  // namespace armature::test
