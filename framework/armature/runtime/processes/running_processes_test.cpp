// SPDX-License-Identifier: Apache-2.0
#include "armature/runtime/processes/running_processes.hpp"

#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

#include <csignal>

#include "armature/runtime/processes/instance_lock.hpp"

namespace armature {
namespace {

const std::string kDeployment = "running_" + std::to_string(getpid());

/// Those of the test among all that run on this machine.
std::vector<RunningProcess> found_in(int domain) {
  auto running = running_processes(domain);
  std::erase_if(running, [](const auto& one) { return one.deployment != kDeployment; });
  return running;
}

TEST(RunningProcesses, AreThoseOfTheDomainThatHoldTheirLocks) {
  {
    const auto main = InstanceLock::take(lock_of_process(kDeployment, 7, "main"));
    const auto aside = InstanceLock::take(lock_of_process(kDeployment, 7, "two words"));
    const auto elsewhere = InstanceLock::take(lock_of_process(kDeployment, 77, "main"));
    const auto running = found_in(7);
    ASSERT_EQ(running.size(), 2U);
    const std::string pid = " (pid " + std::to_string(getpid()) + ")";
    EXPECT_EQ(running[0].text(), "deployment '" + kDeployment + "'" + pid);
    EXPECT_EQ(running[1].text(), "process 'two words' of deployment '" + kDeployment + "'" + pid);
    EXPECT_FALSE(running[0].halted);
  }
  EXPECT_TRUE(found_in(7).empty());
}

TEST(RunningProcesses, AreFoundWhileTheyAreHalted) {
  const pid_t child = fork();
  if (child == 0) {
    const auto lock = InstanceLock::take(lock_of_process(kDeployment, 8, "main"));
    raise(SIGSTOP);
    _exit(lock ? 0 : 1);
  }
  int status = 0;
  ASSERT_EQ(waitpid(child, &status, WUNTRACED), child);
  const auto halted = found_in(8);
  kill(child, SIGCONT);
  waitpid(child, &status, 0);
  ASSERT_EQ(halted.size(), 1U);
  EXPECT_EQ(halted.front().pid, child);
  EXPECT_TRUE(halted.front().halted);
}

}  // namespace
}  // namespace armature
