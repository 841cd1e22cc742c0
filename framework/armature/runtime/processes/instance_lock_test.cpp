// SPDX-License-Identifier: Apache-2.0
#include "armature/runtime/processes/instance_lock.hpp"

#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <csignal>

namespace armature {
namespace {

const std::string kName = "lock_test_" + std::to_string(getpid());

TEST(InstanceLock, ASecondOneIsToldThePidOfTheFirst) {
  const auto first = InstanceLock::take(kName);
  ASSERT_TRUE(first);
  for (int asked = 0; asked < 3; ++asked) {
    const auto second = InstanceLock::take(kName);
    ASSERT_FALSE(second);
    EXPECT_EQ(second.error().text, "pid " + std::to_string(getpid()));
    EXPECT_EQ(InstanceLock::check(kName).error().text, second.error().text);
  }
}

TEST(InstanceLock, IsFreeAgainWhenTheFirstEnds) {
  { ASSERT_TRUE(InstanceLock::take(kName)); }
  EXPECT_TRUE(InstanceLock::check(kName));
  EXPECT_TRUE(InstanceLock::take(kName));
}

TEST(InstanceLock, IsFreeAgainWhenItsHolderIsKilled) {
  std::array<int, 2> taken{};
  ASSERT_EQ(pipe(taken.data()), 0);
  const pid_t holder = fork();
  if (holder == 0) {
    const auto held = InstanceLock::take(kName);
    if (write(taken[1], "x", 1) == 1) pause();
    _exit(1);
  }
  char byte = 0;
  ASSERT_EQ(read(taken[0], &byte, 1), 1);
  EXPECT_EQ(InstanceLock::check(kName).error().text, "pid " + std::to_string(holder));
  kill(holder, SIGKILL);
  waitpid(holder, nullptr, 0);
  EXPECT_TRUE(InstanceLock::take(kName));
  for (const int end : taken) close(end);
}

TEST(InstanceLock, IsNotHeldByWhatItsHolderHasForked) {
  std::array<int, 2> lives{};
  ASSERT_EQ(pipe(lives.data()), 0);
  pid_t forked = 0;
  {
    const auto held = InstanceLock::take(kName);
    forked = fork();
    if (forked == 0 && write(lives[1], "x", 1) == 1) pause();
    char byte = 0;
    ASSERT_EQ(read(lives[0], &byte, 1), 1);
  }
  EXPECT_TRUE(InstanceLock::take(kName)) << "a library that forks lives on without it";
  kill(forked, SIGKILL);
  waitpid(forked, nullptr, 0);
  for (const int end : lives) close(end);
}

TEST(InstanceLock, KeepsNamesApartHoweverLongTheyAre) {
  const std::string same(200, 'x');
  const auto first = InstanceLock::take(kName + same + "a");
  EXPECT_TRUE(InstanceLock::take(kName + same + "b"));
  EXPECT_FALSE(InstanceLock::take(kName + same + "a"));
}

TEST(InstanceLock, IsSeenAlsoWhenItHasBeenAskedForTooOftenToTellItsHolder) {
  const auto lock = InstanceLock::take(kName);
  for (int asked = 0; asked < 5000; ++asked) ASSERT_FALSE(InstanceLock::check(kName));
  const auto held = InstanceLock::held(kName);
  ASSERT_EQ(held.size(), 1U);
  EXPECT_EQ(held.front().name, kName);
  EXPECT_EQ(held.front().holder, 0);
}

}  // namespace
}  // namespace armature
