// SPDX-License-Identifier: Apache-2.0
#include "armature/values/wake_up.hpp"

#include <gtest/gtest.h>

#include <thread>

namespace armature {
namespace {

using Clock = std::chrono::steady_clock;

TEST(WakeUp, RemembersACallThatCameBeforeTheWaitButSeveralAsOne) {
  WakeUp wake;
  for (int i = 0; i < 3; ++i) wake.notify();
  wake.wait();
  EXPECT_FALSE(wake.wait_until(Clock::now()));
}

TEST(WakeUp, WaitsNoLongerThanUntilItsInstantAndNoShorter) {
  WakeUp wake;
  const auto end = Clock::now() + std::chrono::milliseconds{5};
  EXPECT_FALSE(wake.wait_until(end));
  EXPECT_GE(Clock::now(), end);
}

TEST(WakeUp, NeverLosesWhatWasSaidBeforeACall) {
  WakeUp there, back;
  int said = 0;
  std::thread other{[&] {
    for (int i = 1; i <= 10000; ++i) {
      there.wait();
      EXPECT_EQ(said, i);
      back.notify();
    }
  }};
  for (int i = 1; i <= 10000; ++i) {
    said = i;
    there.notify();
    back.wait();
  }
  other.join();
}

}  // namespace
}  // namespace armature
