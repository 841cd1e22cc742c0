// SPDX-License-Identifier: Apache-2.0
#include "armature/runtime/execution/watchdog.hpp"

#include <gtest/gtest.h>

#include <atomic>
#include <chrono>
#include <mutex>
#include <thread>

#include "armature/runtime/testing/fake_setup.hpp"
#include "armature/values/sanitizer.hpp"

namespace armature {
namespace {

using std::chrono::milliseconds;

/// A component whose step hangs while it is told to, on a thread of its own.
class WatchdogTest : public testing::Test {
 protected:
  ~WatchdogTest() override { let_go(); }

  void watch(bool stops_run) {
    watchdog_.emplace(
        std::vector<Watchdog::Watched>{
            {.runner = hung_.get(), .max_step = milliseconds{20}, .stops_run = stops_run},
            {.runner = quick_.get(), .max_step = milliseconds{20}, .stops_run = true}},
        0, [this](const std::string& note) {
          const std::scoped_lock lock{mutex_};
          notes_.push_back(note);
        });
  }
  void hang() {
    thread_ = std::thread{[this] { hung_->activate({}); }};
  }
  void let_go() {
    hangs_ = false;
    if (thread_.joinable()) thread_.join();
  }
  std::vector<std::string> notes() {
    const std::scoped_lock lock{mutex_};
    return notes_;
  }
  static bool comes(const std::function<bool()>& condition) {
    for (int i = 0; i < 30000 && !condition(); ++i) std::this_thread::sleep_for(milliseconds{1});
    return condition();
  }

  std::atomic<bool> hangs_{true};
  const std::unique_ptr<ComponentRunner> hung_ = make_runner("planner", 0, [this](Time) {
    while (hangs_) std::this_thread::sleep_for(milliseconds{1});
  });
  const std::unique_ptr<ComponentRunner> quick_ = make_runner("arm", 1, [](Time) {});
  std::mutex mutex_;
  std::vector<std::string> notes_;
  std::optional<Watchdog> watchdog_;
  std::thread thread_;
};

TEST_F(WatchdogTest, AStepThatHangsIsSaidOnceMarkedAndForgivenWhenItReturns) {
  watch(false);
  hang();
  ASSERT_TRUE(comes([&] { return hung_->stalled() > milliseconds{40}; }));
  EXPECT_EQ(quick_->stalled(), Duration{0});
  ASSERT_EQ(notes().size(), 1U);
  EXPECT_TRUE(notes()[0].starts_with("the step of 'planner' has not returned for 0.0"))
      << notes()[0];
  let_go();
  ASSERT_TRUE(comes([&] { return hung_->stalled() == Duration{0}; }));
  EXPECT_EQ(notes().back(), "the step of 'planner' has returned");
  EXPECT_EQ(watchdog_->verdict(), "") << "the run goes on without it";
}

TEST_F(WatchdogTest, OnTheWayToADriverItsVerdictStandsAlsoWhenTheStepHasReturned) {
  watch(true);
  hang();
  ASSERT_TRUE(comes([&] { return !watchdog_->verdict().empty(); }));
  let_go();
  ASSERT_TRUE(comes([&] { return hung_->stalled() == Duration{0}; }));
  EXPECT_TRUE(watchdog_->verdict().starts_with("the step of 'planner' has not returned for 0.0"))
      << watchdog_->verdict();
}

TEST_F(WatchdogTest, ManyQuickStepsAreNoHungOne) {
  watch(true);
  const auto end = std::chrono::steady_clock::now() + milliseconds{100};
  while (std::chrono::steady_clock::now() < end) quick_->activate({});
  EXPECT_EQ(watchdog_->verdict(), "");
  EXPECT_TRUE(notes().empty());
}

TEST(MaxStep, IsWhatThePluginSaysElseThreePeriodsButNeverLessThanHalfASecond) {
  const int slowdown = kSanitized ? 5 : 1;
  EXPECT_EQ(max_step_of(seconds(0.1), seconds(1)), slowdown * seconds(0.1));
  EXPECT_EQ(max_step_of({}, seconds(1)), slowdown * seconds(3));
  EXPECT_EQ(max_step_of({}, seconds(0.001)), slowdown * seconds(0.5));
  EXPECT_EQ(max_step_of({}, {}), slowdown * seconds(2));
}

}  // namespace
}  // namespace armature
