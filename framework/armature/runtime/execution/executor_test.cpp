// SPDX-License-Identifier: Apache-2.0
// What an executor asks of the operating system: seen from its own thread.
#include "armature/runtime/execution/executor.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <linux/capability.h>
#include <pthread.h>
#include <sched.h>
#include <sys/mman.h>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <sys/syscall.h>
#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <fstream>
#include <future>
#include <thread>

#include "armature/runtime/testing/fake_setup.hpp"
#include "armature/values/sanitizer.hpp"

namespace armature {
namespace {

/// How the thread that runs a component is scheduled.
struct Scheduling {
  std::string thread_name;
  int policy = -1, priority = -1, timer_slack_ns = 0;
  std::vector<int> cpus;
};

Scheduling scheduling_of_this_thread() {
  Scheduling seen;
  char name[16] = {};
  pthread_getname_np(pthread_self(), name, sizeof name);
  seen.thread_name = name;
  sched_param parameters{};
  pthread_getschedparam(pthread_self(), &seen.policy, &parameters);
  seen.priority = parameters.sched_priority;
  seen.timer_slack_ns = prctl(PR_GET_TIMERSLACK, 0UL, 0UL, 0UL, 0UL);
  cpu_set_t set;
  pthread_getaffinity_np(pthread_self(), sizeof set, &set);
  for (int cpu = 0; cpu < CPU_SETSIZE; ++cpu) {
    if (CPU_ISSET(static_cast<std::size_t>(cpu), &set)) seen.cpus.push_back(cpu);
  }
  return seen;
}

class ExecutorTest : public testing::Test {
 protected:
  /// What the first step of a component sees under the settings of `spec`; keeps the executor's
  /// notes.
  Scheduling run(ExecutorSpec spec) {
    if (!spec.period) spec.period = seconds(0.001);
    std::promise<Scheduling> first;
    int steps = 0;
    const auto runner = make_runner("probe", 0, [&](Time) {
      if (steps++ == 0) first.set_value(scheduling_of_this_thread());
    });
    Executor executor{std::move(spec), clock_};
    executor.assign(*runner);
    executor.start([&](const std::string& note) { notes_.push_back(note); });
    return first.get_future().get();
  }

  const SystemClock clock_;
  std::vector<std::string> notes_;
};

/// A CPU that this process may use.
int some_cpu() { return scheduling_of_this_thread().cpus.back(); }

/// Takes a right from the calling thread.
void give_up(unsigned capability) {
  __user_cap_header_struct header{.version = _LINUX_CAPABILITY_VERSION_3, .pid = 0};
  __user_cap_data_struct data[2] = {};
  ASSERT_EQ(syscall(SYS_capget, &header, data), 0);
  data[0].effective &= ~(1U << capability);
  ASSERT_EQ(syscall(SYS_capset, &header, data), 0);
}

/// Takes the right to raise priorities from the calling thread.
void give_up_priorities() {
  give_up(CAP_SYS_NICE);
  rlimit limit{};
  ASSERT_EQ(getrlimit(RLIMIT_RTPRIO, &limit), 0);
  limit.rlim_cur = 0;
  ASSERT_EQ(setrlimit(RLIMIT_RTPRIO, &limit), 0);
}

TEST_F(ExecutorTest, ItsThreadHasItsNameAndIsPinnedToItsCpu) {
  const int cpu = some_cpu();
  const Scheduling seen = run({.name = "control", .period = {}, .priority = 0, .cpu = cpu});
  EXPECT_EQ(seen.thread_name, "control");
  EXPECT_EQ(seen.cpus, std::vector<int>{cpu});
  EXPECT_EQ(seen.policy, SCHED_OTHER);
  EXPECT_TRUE(notes_.empty()) << notes_.front();
}

TEST_F(ExecutorTest, WithoutACpuItMayRunOnAll) {
  const Scheduling seen = run({.name = "vision", .period = {}, .priority = 0});
  EXPECT_EQ(seen.cpus, scheduling_of_this_thread().cpus);
}

TEST_F(ExecutorTest, ACpuThatTheMachineDoesNotHaveIsNoted) {
  const Scheduling seen = run({.name = "control", .period = {}, .priority = 0, .cpu = 1023});
  EXPECT_EQ(
      notes_,
      (std::vector<std::string>{"executor 'control' is not pinned to cpu 1023: Invalid argument"}));
  EXPECT_EQ(seen.cpus, scheduling_of_this_thread().cpus);
}

TEST_F(ExecutorTest, ItsPriorityIsSetOrTheNoteSaysWhyNot) {
  const Scheduling seen = run({.name = "control", .period = {}, .priority = 7});
  if (notes_.empty()) {
    EXPECT_EQ(seen.policy, SCHED_FIFO);
    EXPECT_EQ(seen.priority, 7);
  } else {
    EXPECT_EQ(notes_, (std::vector<std::string>{"executor 'control' runs without priority 7: "
                                                "Operation not permitted"}));
    EXPECT_EQ(seen.policy, SCHED_OTHER);
  }
}

TEST_F(ExecutorTest, APriorityThatIsRefusedIsNotedAndItRunsAllTheSame) {
  std::thread{[&] {
    give_up_priorities();
    const Scheduling seen = run({.name = "control", .period = {}, .priority = 7});
    EXPECT_EQ(seen.policy, SCHED_OTHER);
    EXPECT_EQ(seen.priority, 0);
  }}.join();
  EXPECT_EQ(notes_, (std::vector<std::string>{
                        "executor 'control' runs without priority 7: Operation not permitted"}));
}

TEST_F(ExecutorTest, AThreadWithAPeriodWakesWithoutTheSlackOfTimers) {
  EXPECT_EQ(run({.name = "control", .period = seconds(0.002)}).timer_slack_ns, 1);
}

/// How much of this process's memory is locked [KiB].
long locked_kib() {
  std::ifstream file{"/proc/self/status"};
  for (std::string word; file >> word;) {
    if (word != "VmLck:") continue;
    long kib = 0;
    file >> kib;
    return kib;
  }
  return 0;
}

TEST_F(ExecutorTest, MemoryIsLockedOrTheNoteSaysWhyNot) {
  if (kSanitized) GTEST_SKIP() << "a sanitizer's shadow memory cannot be locked";
  run({.name = "control", .period = {}, .lock_memory = true});
  if (notes_.empty()) {
    EXPECT_GT(locked_kib(), 1000);
  } else {
    EXPECT_TRUE(notes_[0].starts_with("executor 'control' runs without locked memory: "));
  }
  munlockall();
}

TEST_F(ExecutorTest, ALimitUnderWhichMemoryThatIsAskedForLaterWouldBeRefusedIsNoted) {
  std::thread{[&] {
    give_up(CAP_IPC_LOCK);
    rlimit limit{};
    ASSERT_EQ(getrlimit(RLIMIT_MEMLOCK, &limit), 0);
    limit.rlim_cur = std::min<rlim_t>(limit.rlim_max, 64 * 1024);
    ASSERT_EQ(setrlimit(RLIMIT_MEMLOCK, &limit), 0);
    run({.name = "control", .period = {}, .lock_memory = true});
  }}.join();
  EXPECT_EQ(notes_, (std::vector<std::string>{
                        "executor 'control' runs without locked memory: the limit is 64 KiB; raise "
                        "it (ulimit -l unlimited, or 'memlock' in /etc/security/limits.conf)"}));
  EXPECT_EQ(locked_kib(), 0);
}

TEST_F(ExecutorTest, KnowsOfEveryStepHowLateItBeganAndHowLongItTook) {
  std::atomic<int> steps{0};
  const auto paced = make_runner("paced", 0, [&](Time) {
    std::this_thread::sleep_for(std::chrono::milliseconds{2});
    ++steps;
  });
  const auto after = make_runner("after", 1, [](Time) {});
  Executor executor{{.name = "control", .period = seconds(0.01)}, clock_};
  executor.assign(*paced);
  executor.assign(*after);
  executor.start([](const std::string&) {});
  while (steps < 5) std::this_thread::sleep_for(std::chrono::milliseconds{1});
  executor.request_stop();
  executor.join();
  const auto figures = [](const TimingHistogram& histogram) {
    return histogram.counts().figures();
  };
  EXPECT_EQ(figures(paced->times().duration).count, paced->activations());
  EXPECT_GE(figures(paced->times().duration).mean_s, 0.002);
  EXPECT_LT(figures(paced->times().processor).mean_s, figures(paced->times().duration).mean_s)
      << "it slept";
  EXPECT_GE(figures(after->times().lateness).mean_s, 0.002) << "it waits for the one before";
  EXPECT_EQ(*after->executor_name(), "control");
  EXPECT_EQ(after->executor_times(), &executor.times());
  EXPECT_GE(figures(executor.times().duration).mean_s, 0.002);
  EXPECT_LT(figures(executor.times().lateness).mean_s, figures(after->times().lateness).mean_s);
}

TEST_F(ExecutorTest, WhoseStepMadeAnotherComeLateIsToldOnce) {
  constexpr auto kHold = std::chrono::milliseconds{kSanitized ? 1000 : 300};
  std::atomic<int> steps{0};
  const auto slow = make_runner("slow", 0, [&](Time) {
    if (steps % 3 == 2) std::this_thread::sleep_for(kHold);
  });
  const auto arm = make_runner("arm", 1, [&](Time) { ++steps; });
  Executor executor{{.name = "control", .period = seconds(0.01)}, clock_};
  executor.assign(*slow);
  executor.assign(*arm);
  std::vector<std::string> notes;
  executor.start([](const std::string&) {},
                 [&](const std::string& note) { notes.push_back(note); });
  while (steps < 7) std::this_thread::sleep_for(std::chrono::milliseconds{1});
  executor.request_stop();
  executor.join();
  ASSERT_EQ(notes.size(), 1U);
  EXPECT_THAT(notes[0], testing::MatchesRegex("'arm' was activated [0-9.]+ s late: the step of "
                                              "'slow', which shares executor 'control', took "
                                              "[0-9.]+ s"));
}

TEST_F(ExecutorTest, AStepThatMadeItsOwnNextOneComeLateIsTold) {
  std::atomic<int> steps{0};
  const auto slow = make_runner("slow", 0, [&](Time) {
    if (++steps == 2) std::this_thread::sleep_for(std::chrono::seconds{1});
  });
  Executor executor{{.name = "control", .period = seconds(0.01)}, clock_};
  executor.assign(*slow);
  std::vector<std::string> notes;
  executor.start([](const std::string&) {},
                 [&](const std::string& note) { notes.push_back(note); });
  while (steps < 4) std::this_thread::sleep_for(std::chrono::milliseconds{1});
  executor.request_stop();
  executor.join();
  ASSERT_EQ(notes.size(), 1U);
  EXPECT_THAT(notes[0], testing::HasSubstr("s late: its own step before took 1."));
}

TEST_F(ExecutorTest, ATriggeredStepIsAsLateAsItsTriggerIsOld) {
  MessageType type;
  type.create = [] { return static_cast<void*>(new int{}); };
  type.destroy = [](void* message) { delete static_cast<int*>(message); };
  SamplePool pool{type, 2};
  std::atomic<bool> busy{false}, done{false};
  const auto slow = make_runner("slow", 0, [&](Time) {
    busy = true;
    std::this_thread::sleep_for(std::chrono::milliseconds{20});
  });
  const auto waiting = make_runner("waiting", 1, [&](Time) { done = true; });
  InputPort& start = slow->inbox().add({.name = "in", .trigger = true}, type);
  InputPort& trigger = waiting->inbox().add({.name = "in", .trigger = true}, type);
  Executor executor{{.name = "main", .period = {}}, clock_};
  executor.assign(*slow);
  executor.assign(*waiting);
  executor.start([](const std::string&) {});
  start.deliver(pool.loan());
  while (!busy) std::this_thread::yield();
  trigger.deliver(pool.loan());
  while (!done) std::this_thread::sleep_for(std::chrono::milliseconds{1});
  executor.request_stop();
  executor.join();
  EXPECT_GE(waiting->times().lateness.counts().figures().max_s, 0.005);
  EXPECT_LT(slow->times().lateness.counts().figures().max_s,
            waiting->times().lateness.counts().figures().max_s);
}

TEST_F(ExecutorTest, AStopReachesAUnitThatNothingActivatesAndAJoinThatIsTooLongNamesTheUnit) {
  std::atomic<bool> hangs{true}, entered{false};
  const auto hung = make_runner("hung", 0, [&](Time) {
    entered = true;
    while (hangs) std::this_thread::sleep_for(std::chrono::milliseconds{1});
  });
  const auto idle = make_runner("idle", 1, [](Time) {});
  Executor quiet{{.name = "quiet", .period = {}}, clock_};
  quiet.assign(*idle);
  quiet.start([](const std::string&) {});
  quiet.begin_stop();
  while (!idle->stopped()) std::this_thread::sleep_for(std::chrono::milliseconds{1});
  EXPECT_EQ(idle->activations(), 0U);

  Executor executor{{.name = "control", .period = seconds(0.001)}, clock_};
  executor.assign(*hung);
  executor.start([](const std::string&) {});
  while (!entered) std::this_thread::sleep_for(std::chrono::milliseconds{1});
  executor.request_stop();
  EXPECT_FALSE(executor.join_for(seconds(0.02)));
  ASSERT_NE(executor.running(), nullptr);
  EXPECT_EQ(executor.running()->name(), "hung");
  hangs = false;
  EXPECT_TRUE(executor.join_for(seconds(60)));
  EXPECT_EQ(executor.running(), nullptr);
}

}  // namespace
}  // namespace armature
