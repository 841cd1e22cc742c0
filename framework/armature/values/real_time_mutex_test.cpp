// SPDX-License-Identifier: Apache-2.0
#include "armature/values/real_time_mutex.hpp"

#include <gtest/gtest.h>
#include <pthread.h>
#include <sched.h>
#include <unistd.h>

#include <atomic>
#include <chrono>
#include <fstream>
#include <iterator>
#include <mutex>
#include <sstream>
#include <string>
#include <thread>

namespace armature {
namespace {

/// The priority that the calling thread runs with now, inherited ones included: -1 - p for the
/// real-time priority p, 0 to 39 for the normal scheduler (proc(5), field 18 of stat).
int running_priority() {
  std::ifstream file{"/proc/self/task/" + std::to_string(gettid()) + "/stat"};
  std::string text{std::istreambuf_iterator<char>{file}, {}};
  std::istringstream fields{text.substr(text.rfind(')') + 2)};  // from field 3
  std::string field;
  for (int i = 3; i <= 18; ++i) fields >> field;
  return std::stoi(field);
}

bool become_urgent(int priority) {
  const sched_param parameters{.sched_priority = priority};
  return pthread_setschedparam(pthread_self(), SCHED_FIFO, &parameters) == 0;
}

TEST(RealTimeMutex, WhoHoldsItRunsWithThePriorityOfWhoWaitsForIt) {
  constexpr int kUrgent = 7;
  RealTimeMutex mutex;
  std::atomic<bool> allowed{true}, asked{false};
  mutex.lock();
  const int before = running_priority();
  std::thread urgent{[&] {
    allowed = become_urgent(kUrgent);
    asked = true;
    const std::scoped_lock lock{mutex};
  }};
  const auto end = std::chrono::steady_clock::now() + std::chrono::seconds{30};
  while (!asked || (allowed && running_priority() != -1 - kUrgent)) {
    if (std::chrono::steady_clock::now() > end) break;
    std::this_thread::sleep_for(std::chrono::milliseconds{1});
  }
  const int inherited = running_priority();
  mutex.unlock();
  urgent.join();
  if (!allowed) GTEST_SKIP() << "real-time priorities are not allowed here";
  EXPECT_EQ(inherited, -1 - kUrgent);
  EXPECT_EQ(running_priority(), before);
}

TEST(RealTimeMutex, IsHeldByOneThreadAtATime) {
  RealTimeMutex mutex;
  std::unique_lock lock{mutex};
  std::thread{[&] { EXPECT_FALSE(mutex.try_lock()); }}.join();
  lock.unlock();
  std::thread{[&] {
    ASSERT_TRUE(mutex.try_lock());
    mutex.unlock();
  }}.join();
}

}  // namespace
}  // namespace armature
