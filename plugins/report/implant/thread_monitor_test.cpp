// SPDX-License-Identifier: Apache-2.0
#include "thread_monitor.hpp"

#include <gtest/gtest.h>

#include <numbers>

namespace armature::report::implant {
namespace {

using Eigen::Vector3d;

constexpr double kTurn = 2 * std::numbers::pi;
const Thread kThread{.start = {0, 0, 0.4}, .axis = Vector3d::UnitX(), .pitch_m = 0.001};

TEST(ThreadMonitor, TellsTheMostThatAnImplantWasAheadOfItsTurnsOrBehind) {
  ThreadMonitor monitor;
  monitor.see({9, 9, 9}, 7);
  EXPECT_EQ(monitor.max_error_m(), std::nullopt) << "no thread yet";
  monitor.engage(kThread);
  monitor.see(kThread.start - 0.01 * kThread.axis, 7);
  EXPECT_EQ(monitor.max_error_m(), 0) << "before it begins";
  monitor.see(kThread.start + 0.002 * kThread.axis, 7 + 1.9 * kTurn);
  EXPECT_NEAR(*monitor.max_error_m(), 0.0001, 1e-12);
  monitor.see(kThread.start + 0.003 * kThread.axis, 7 + 3.3 * kTurn);
  EXPECT_NEAR(*monitor.max_error_m(), 0.0003, 1e-12);
  monitor.engage(std::nullopt);
  monitor.see(kThread.start - 0.03 * kThread.axis, 7 + 3.3 * kTurn);
  EXPECT_NEAR(*monitor.max_error_m(), 0.0003, 1e-12) << "it has been placed";
  monitor.engage(kThread);
  monitor.see(kThread.start + 0.001 * kThread.axis, 50);
  EXPECT_NEAR(*monitor.max_error_m(), 0.001, 1e-12) << "the next begins at its own angle";
  monitor.see(kThread.start, NAN);
  monitor.see(kThread.start, 50);
  EXPECT_EQ(monitor.max_error_m(), std::nullopt) << "how far it had turned meanwhile is not known";
}

}  // namespace
}  // namespace armature::report::implant
