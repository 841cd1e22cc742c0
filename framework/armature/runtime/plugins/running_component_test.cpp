// SPDX-License-Identifier: Apache-2.0
#include "armature/runtime/plugins/running_component.hpp"

#include <gtest/gtest.h>

#include <chrono>
#include <csignal>
#include <cstdlib>
#include <string>
#include <thread>

#include "armature/runtime/execution/executor.hpp"
#include "armature/runtime/testing/fake_setup.hpp"
#include "armature/values/sanitizer.hpp"

namespace armature {
namespace {

/// Runs a step on an executor's thread; it does not come back.
void run_step(const std::function<void(Time)>& step) {
  name_crashing_components();
  const SystemClock clock;
  const auto runner = make_runner("camera", 0, step);
  Executor executor{{.name = "vision", .period = seconds(0.001)}, clock};
  executor.assign(*runner);
  executor.start([](const std::string&) {});
  std::this_thread::sleep_for(std::chrono::seconds{30});
}

void run_nothing_more() {
  const std::string name = "arm";
  const RunningComponent running{name, "step"};
}

/// Needs a stack that nothing has.
[[gnu::noinline]] int without_end(int depth) {
  volatile char much[4096];
  much[0] = static_cast<char>(depth);
  return depth < 0 ? 0 : without_end(depth + 1) + much[0];
}

class CrashTest : public testing::Test {
 protected:
  void SetUp() override {
    if (kSanitized) GTEST_SKIP() << "a sanitizer tells of a crash by itself";
    testing::FLAGS_gtest_death_test_style = "threadsafe";
  }
};
using CrashDeathTest = CrashTest;

TEST_F(CrashDeathTest, NamesTheComponentWhoseStepRanAndEndsAsItWouldHave) {
  EXPECT_EXIT(run_step([](Time) { std::raise(SIGSEGV); }), testing::KilledBySignal(SIGSEGV),
              "armature: component 'camera' crashed in its step: SIGSEGV\n");
  EXPECT_EXIT(run_step([](Time) { std::abort(); }), testing::KilledBySignal(SIGABRT),
              "armature: component 'camera' crashed in its step: SIGABRT\n");
}

TEST_F(CrashDeathTest, NamesItAlsoWhenItsStackIsFull) {
  EXPECT_EXIT(run_step([](Time) { without_end(0); }), testing::KilledBySignal(SIGSEGV),
              "armature: component 'camera' crashed in its step: SIGSEGV\n");
}

/// As lockstep does, on the thread that watches for crashes.
void run_out_of_stack_here() {
  const auto runner = make_runner("camera", 0, [](Time) { without_end(0); });
  name_crashing_components();
  runner->activate({});
}

TEST_F(CrashDeathTest, NamesItInLockstepToo) {
  EXPECT_EXIT(run_out_of_stack_here(), testing::KilledBySignal(SIGSEGV),
              "armature: component 'camera' crashed in its step: SIGSEGV\n");
}

TEST_F(CrashDeathTest, ElsewhereSaysThatItWasNoComponentsStep) {
  EXPECT_EXIT(
      {
        name_crashing_components();
        run_nothing_more();
        std::raise(SIGBUS);
      },
      testing::KilledBySignal(SIGBUS), "armature: crashed outside of a component's step: SIGBUS\n");
}

}  // namespace
}  // namespace armature
