// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <atomic>
#include <set>
#include <thread>

#include "armature/runtime/execution/lockstep_scheduler.hpp"
#include "armature/runtime/execution/threaded_scheduler.hpp"
#include "armature/runtime/testing/fake_setup.hpp"

namespace armature {
namespace {

MessageType number_type() {
  MessageType type;
  type.ros_name = "test_msgs/Number";
  type.create = [] { return static_cast<void*>(new int{}); };
  type.destroy = [](void* message) { delete static_cast<int*>(message); };
  return type;
}

TEST(LockstepScheduler, ActivatesInTheOrderOfTimeThenGraph) {
  SimulatedClock clock;
  LockstepScheduler scheduler{clock};
  std::vector<std::string> log;
  const auto record = [&](const std::string& name) {
    return [&log, name](Time now) { log.push_back(name + "@" + std::to_string(now.ns)); };
  };
  const auto late = make_runner("late", 1, record("late"));
  const auto early = make_runner("early", 0, record("early"));
  scheduler.assign({.name = "a", .period = Duration{20}}, {late.get()});
  scheduler.assign({.name = "b", .period = Duration{10}}, {early.get()});
  scheduler.run([&] { return log.size() >= 5; });
  EXPECT_EQ(log,
            (std::vector<std::string>{"early@0", "late@0", "early@10", "early@20", "late@20"}));
}

TEST(LockstepScheduler, WhatAPauseOfItsThreadHoldsUpComesLateButNeverInABurst) {
  for (std::uint64_t seed = 0; seed < 20; ++seed) {
    SimulatedClock clock;
    LockstepScheduler scheduler{clock};
    std::vector<std::int64_t> log;
    const auto record = [&](Time now) { log.push_back(now.ns); };
    const auto first = make_runner("first", 0, record), second = make_runner("second", 1, record);
    scheduler.assign({.name = "a", .period = Duration{10}, .sim_pause = Duration{25}, .seed = seed},
                     {first.get(), second.get()});
    scheduler.run([&] { return clock.now().ns >= 10'000 && log.size() % 2 == 0; });
    EXPECT_NEAR(static_cast<double>(first->activations() + first->overruns()), 1001, 3);
    EXPECT_GT(first->overruns(), 50U) << "seed " << seed;
    std::size_t late = 0;
    for (std::size_t i = 0; i < log.size(); i += 2) {
      EXPECT_EQ(log[i], log[i + 1]) << "one thread is held up for both, seed " << seed;
      if (i > 0) {
        EXPECT_NE(log[i] / 10, log[i - 1] / 10) << "seed " << seed;
      }
      if (log[i] % 10 != 0) ++late;
    }
    EXPECT_GT(late, 50U) << "seed " << seed;
    EXPECT_NEAR(first->times().lateness.counts().figures().max_s, 25e-9, 3e-9);
  }
}

TEST(LockstepScheduler, WhatTriggersAHeldUpThreadAgainAndAgainActivatesItOnce) {
  SimulatedClock clock;
  LockstepScheduler scheduler{clock};
  const MessageType type = number_type();
  Topic topic{{.name = "rt/n", .type = &type}, 100};
  const auto source =
      make_runner("source", 0, [&](Time) { scheduler.publish(topic, topic.loan()); });
  std::vector<std::int64_t> seen;
  const auto sink = make_runner("sink", 1, [&](Time now) { seen.push_back(now.ns); });
  topic.connect(sink->inbox().add({.name = "in", .trigger = true}, type));
  scheduler.assign({.name = "a", .period = Duration{10}}, {source.get()});
  scheduler.assign({.name = "b", .period = {}, .sim_pause = Duration{1000}}, {sink.get()});
  scheduler.run([&] { return clock.now().ns >= 100'000; });
  EXPECT_LT(sink->activations(), 0.9 * static_cast<double>(source->activations()));
  EXPECT_EQ(std::set(seen.begin(), seen.end()).size(), seen.size());
}

TEST(LockstepScheduler, WhatTriggersAHeldUpThreadInItsOwnCycleActivatesItOnce) {
  SimulatedClock clock;
  LockstepScheduler scheduler{clock};
  const MessageType type = number_type();
  Topic topic{{.name = "rt/n", .type = &type}, 100};
  std::vector<std::int64_t> sent, seen;
  const auto source = make_runner("source", 0, [&](Time now) {
    sent.push_back(now.ns);
    scheduler.publish(topic, topic.loan());
  });
  const auto sink = make_runner("sink", 1, [&](Time now) { seen.push_back(now.ns); });
  topic.connect(sink->inbox().add({.name = "in", .trigger = true}, type));
  scheduler.assign({.name = "a", .period = Duration{7}}, {source.get()});
  scheduler.assign({.name = "b", .period = Duration{10}, .sim_pause = Duration{25}}, {sink.get()});
  scheduler.run([&] { return clock.now().ns >= 100'000; });
  for (std::size_t i = 1; i < seen.size(); ++i) {
    if (seen[i] != seen[i - 1]) continue;
    EXPECT_TRUE(seen[i] % 7 == 0) << seen[i] << ": no message came then";
  }
  for (const std::int64_t at : sent) {
    const auto next = std::ranges::lower_bound(seen, at);
    EXPECT_TRUE(next == seen.end() || *next - at <= 26) << at << ": a message was not minded";
  }
}

TEST(LockstepScheduler, DeliversAtOnceWithoutLatencyAndLaterWithOne) {
  for (const Duration latency : {Duration{0}, Duration{7}}) {
    SimulatedClock clock;
    LockstepScheduler scheduler{clock};
    const MessageType type = number_type();
    Topic topic{{.name = "rt/n", .type = &type}, 2};
    const auto source =
        make_runner("source", 0, [&](Time) { scheduler.publish(topic, topic.loan()); });
    std::vector<std::int64_t> seen;
    const auto sink = make_runner("sink", 1, [&](Time now) { seen.push_back(now.ns); });
    topic.connect(sink->inbox().add({.name = "in", .trigger = true}, type));
    source->set_latency(latency);
    scheduler.assign({.name = "a", .period = Duration{100}}, {source.get()});
    scheduler.assign({.name = "b", .period = {}}, {sink.get()});
    scheduler.run([&] { return seen.size() >= 2; });
    EXPECT_EQ(seen, (std::vector<std::int64_t>{latency.count(), 100 + latency.count()}));
  }
}

TEST(LockstepScheduler, WhenItStopsNothingIsOnItsWayAnyMore) {
  SimulatedClock clock;
  LockstepScheduler scheduler{clock};
  const MessageType type = number_type();
  Topic topic{{.name = "rt/n", .type = &type}, 1};
  const auto source =
      make_runner("source", 0, [&](Time) { scheduler.publish(topic, topic.loan()); });
  source->set_latency(Duration{7});
  scheduler.assign({.name = "a", .period = Duration{100}}, {source.get()});
  scheduler.run([&] { return source->activations() == 1; });
  scheduler.stop(seconds(60));
  topic.loan();
  EXPECT_EQ(topic.pool_growth(), 0U);  // the one sample is back
}

TEST(LockstepScheduler, EndsWhenNothingIsLeftToDo) {
  SimulatedClock clock;
  LockstepScheduler scheduler{clock};
  scheduler.run([] { return false; });
  EXPECT_EQ(clock.now().ns, 0);
}

TEST(ComponentRunner, AnExceptionBecomesItsFaultAndItIsNotCalledAgain) {
  int calls = 0;
  const auto runner = make_runner("arm", 0, [&](Time) {
    ++calls;
    throw std::runtime_error("joint 3 is gone");
  });
  runner->activate({});
  runner->activate({});
  EXPECT_EQ(calls, 1);
  EXPECT_TRUE(runner->faulted());
  EXPECT_EQ(runner->reporter()->status().reason, "step failed: joint 3 is gone");
}

TEST(ComponentRunner, AFaultEndsItsOutputsWhicheverOfItsThreadsStillPublishes) {
  SimulatedClock clock;
  LockstepScheduler scheduler{clock};
  const MessageType type = number_type();
  Topic topic{{.name = "rt/n", .type = &type}, 2};
  const auto runner = make_runner("camera", 0, [](Time) { throw std::runtime_error("no light"); });
  OutputPort& output =
      runner->outputs().emplace_back(PortSpec{.name = "n"}, topic, scheduler, runner->inbox());
  output.open();
  output.publish(topic.loan());
  EXPECT_EQ(topic.published(), 1U);
  runner->activate({});
  output.publish(topic.loan());
  EXPECT_EQ(topic.published(), 1U);
  EXPECT_FALSE(output.has_subscribers());
}

/// Something that moves and needs steps to come to rest.
class Mover final : public Component {
 public:
  Mover(Setup& setup, int steps_to_rest) : Component{setup}, steps_to_rest_{steps_to_rest} {}
  void step(Time) override {
    log.push_back("step");
    if (!missed.empty()) degraded(missed);
    if (broken) throw std::runtime_error{"a joint is blocked"};
    if (stopping_ && steps_to_rest_ > 0) --steps_to_rest_;
  }
  void begin_stop(Time now) override {
    log.push_back("begin_stop@" + std::to_string(now.ns));
    stopping_ = true;
  }
  bool stopped() const override { return steps_to_rest_ == 0; }
  bool finished() const override { return told; }

  std::vector<std::string> log;
  std::string missed;  // what it misses
  bool told = false, broken = false;

 private:
  int steps_to_rest_;
  bool stopping_ = false;
};

TEST(ComponentRunner, LosesNothingOnceItsScenarioIsTold) {
  const MessageType type = number_type();
  SamplePool pool{type, 4};
  ComponentRunner runner{"report", "test/mover", 0, {}};
  FakeSetup setup{runner};
  auto report = std::make_unique<Mover>(setup, 0);
  Mover& scenario = *report;
  runner.install(nullptr, std::move(report));
  InputPort& samples = runner.inbox().add({.name = "in", .queue = 2}, pool.type());
  for (int i = 0; i < 5; ++i) samples.deliver(pool.loan());
  scenario.told = true;
  runner.activate({});
  EXPECT_EQ(runner.dropped(), 3U);
  for (int i = 0; i < 5; ++i) samples.deliver(pool.loan());
  EXPECT_EQ(runner.dropped(), 3U) << "it reads no more";
}

class StoppingUnit : public testing::Test {
 protected:
  void make(int steps_to_rest) {
    FakeSetup setup{runner_};
    auto mover = std::make_unique<Mover>(setup, steps_to_rest);
    mover_ = mover.get();
    runner_.install(nullptr, std::move(mover));
  }
  std::vector<std::string> lines_;
  ComponentRunner runner_{"mover", "test/mover", 0,
                          [this](std::string_view, std::string_view line, StatusReporter::State) {
                            lines_.emplace_back(line);
                          }};
  Mover* mover_ = nullptr;
};

TEST_F(StoppingUnit, IsToldOnceBeforeItsNextStepAndStepsUntilItIsAtRest) {
  make(2);
  runner_.activate(Time{1});
  EXPECT_FALSE(runner_.stopped()) << "nobody has asked it to";
  runner_.request_stop();
  runner_.activate(Time{2});
  EXPECT_FALSE(runner_.stopped());
  runner_.activate(Time{3});
  EXPECT_TRUE(runner_.stopped());
  EXPECT_EQ(mover_->log, (std::vector<std::string>{"step", "begin_stop@2", "step", "step"}));
}

TEST_F(StoppingUnit, ThatRestsAlreadyNeedsNoStep) {
  make(0);
  runner_.request_stop();
  runner_.answer_stop_request(Time{5});
  runner_.answer_stop_request(Time{6});
  EXPECT_TRUE(runner_.stopped());
  EXPECT_EQ(mover_->log, std::vector<std::string>{"begin_stop@5"});
}

TEST_F(StoppingUnit, ThatRestsDoesNotTellWhatItMissesOfThoseWhoEndBeforeIt) {
  make(1);
  runner_.activate(Time{1});
  runner_.request_stop();
  mover_->missed = "no command for 0.1 s";
  runner_.activate(Time{2});
  EXPECT_EQ(lines_, std::vector<std::string>{mover_->missed}) << "it moved still";
  mover_->missed = "no command for 0.2 s";
  runner_.activate(Time{3});
  EXPECT_EQ(lines_.size(), 1U);
  EXPECT_EQ(runner_.status().reason, mover_->missed) << "it is kept for those who ask";
}

TEST_F(StoppingUnit, ThatRestsTellsItsFaults) {
  make(0);
  runner_.request_stop();
  runner_.activate(Time{1});
  mover_->broken = true;
  runner_.activate(Time{2});
  EXPECT_EQ(lines_, std::vector<std::string>{"FAULT: step failed: a joint is blocked"});
}

TEST_F(StoppingUnit, ThatHasFinishedIsNotSteppedAnyMoreButToldThatTheRunStops) {
  make(0);
  mover_->told = true;
  runner_.activate(Time{1});
  runner_.activate(Time{2});
  runner_.request_stop();
  runner_.activate(Time{3});
  EXPECT_EQ(mover_->log, (std::vector<std::string>{"step", "begin_stop@3"}));
  EXPECT_TRUE(runner_.stopped());
}

TEST(ThreadedScheduler, ActivatesPeriodicallyAndOnTriggersAndStops) {
  const SystemClock clock;
  ThreadedScheduler scheduler{clock, [](const std::string&) {}};
  const MessageType type = number_type();
  Topic topic{{.name = "rt/n", .type = &type}, 2};
  std::atomic<int> sent{0}, received{0};
  const auto source = make_runner("source", 0, [&](Time) {
    if (sent < 20) {
      scheduler.publish(topic, topic.loan());
      ++sent;
    }
  });
  const auto sink = make_runner("sink", 1, [&](Time) { ++received; });
  topic.connect(sink->inbox().add({.name = "in", .queue = 32, .trigger = true}, type));
  scheduler.assign({.name = "periodic", .period = seconds(0.001)}, {source.get()});
  scheduler.assign({.name = "triggered", .period = {}}, {sink.get()});
  scheduler.run([&] { return sent >= 20 && received >= 1; });
  scheduler.stop(seconds(60));
  const int after_stop = received;
  std::this_thread::sleep_for(std::chrono::milliseconds{20});
  EXPECT_EQ(received, after_stop);
  EXPECT_LE(received, 20);
}

TEST(ThreadedScheduler, CountsMissedPeriodsInsteadOfCatchingUp) {
  const SystemClock clock;
  ThreadedScheduler scheduler{clock, [](const std::string&) {}};
  std::atomic<int> calls{0};
  const auto slow = make_runner("slow", 0, [&](Time) {
    if (calls++ == 0) std::this_thread::sleep_for(std::chrono::milliseconds{50});
  });
  scheduler.assign({.name = "control", .period = seconds(0.005)}, {slow.get()});
  scheduler.run([&] { return calls >= 3; });
  scheduler.stop(seconds(60));
  EXPECT_GE(slow->overruns(), 8U);
}

}  // namespace
}  // namespace armature
