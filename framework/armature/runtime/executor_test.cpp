// SPDX-License-Identifier: Apache-2.0
// What an executor asks of the operating system: seen from its own thread.
#include "armature/runtime/executor.hpp"

#include <gtest/gtest.h>
#include <linux/capability.h>
#include <pthread.h>
#include <sched.h>
#include <sys/resource.h>
#include <sys/syscall.h>
#include <unistd.h>

#include <chrono>
#include <condition_variable>
#include <thread>

#include "armature/runtime/fake_setup.hpp"

namespace armature {
namespace {

/// How the thread that runs a unit is scheduled.
struct Scheduling {
  std::string thread_name;
  int policy = -1, priority = -1;
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
  cpu_set_t set;
  pthread_getaffinity_np(pthread_self(), sizeof set, &set);
  for (int cpu = 0; cpu < CPU_SETSIZE; ++cpu) {
    if (CPU_ISSET(static_cast<std::size_t>(cpu), &set)) seen.cpus.push_back(cpu);
  }
  return seen;
}

class ExecutorTest : public testing::Test {
 protected:
  /// Runs one unit until it has seen the settings of `spec`, and keeps the executor's notes.
  Scheduling run(ExecutorSpec spec) {
    spec.period = seconds(0.001);
    std::mutex mutex;
    std::condition_variable arrived;
    Scheduling seen;
    int steps = 0;
    const auto unit = make_unit("probe", 0, [&](Time) {
      const std::scoped_lock lock{mutex};
      if (!started_) return;  // the settings are made while the thread runs already
      seen = scheduling_of_this_thread();
      if (++steps == 2) arrived.notify_one();
    });
    Executor executor{std::move(spec), clock_};
    executor.assign(*unit);
    executor.start([&](const std::string& note) { notes_.push_back(note); });
    std::unique_lock lock{mutex};
    started_ = true;
    EXPECT_TRUE(arrived.wait_for(lock, std::chrono::seconds{30}, [&] { return steps >= 2; }));
    return seen;
  }

  const SystemClock clock_;
  bool started_ = false;
  std::vector<std::string> notes_;
};

/// A CPU that this process may use.
int some_cpu() { return scheduling_of_this_thread().cpus.back(); }

/// Takes the right to raise priorities from the calling thread.
void give_up_priorities() {
  __user_cap_header_struct header{.version = _LINUX_CAPABILITY_VERSION_3, .pid = 0};
  __user_cap_data_struct data[2] = {};
  ASSERT_EQ(syscall(SYS_capget, &header, data), 0);
  data[0].effective &= ~(1U << CAP_SYS_NICE);
  ASSERT_EQ(syscall(SYS_capset, &header, data), 0);
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
  const Scheduling seen = run({.name = "vision", .period = {}, .priority = 0, .cpu = {}});
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
  const Scheduling seen = run({.name = "control", .period = {}, .priority = 7, .cpu = {}});
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
    const Scheduling seen = run({.name = "control", .period = {}, .priority = 7, .cpu = {}});
    EXPECT_EQ(seen.policy, SCHED_OTHER);
    EXPECT_EQ(seen.priority, 0);
  }}.join();
  EXPECT_EQ(notes_, (std::vector<std::string>{
                        "executor 'control' runs without priority 7: Operation not permitted"}));
}

}  // namespace
}  // namespace armature
