// SPDX-License-Identifier: Apache-2.0
#include "armature/values/spawn_plan.hpp"

#include <gtest/gtest.h>
#include <sys/wait.h>

#include <array>
#include <cerrno>

namespace armature {
namespace {

/// What a shell prints that does `line`, started by the plan.
std::string said(SpawnPlan& plan, const std::string& line, int& status) {
  std::array<int, 2> ends{};
  EXPECT_EQ(pipe2(ends.data(), O_CLOEXEC), 0);
  pid_t pid = 0;
  const int error =
      plan.hand_over(ends[1], STDOUT_FILENO).start("/bin/sh", {"sh", "-c", line}, pid);
  EXPECT_EQ(error, 0);
  close(ends[1]);
  std::string text;
  std::array<char, 256> piece;
  for (ssize_t size; (size = read(ends[0], piece.data(), piece.size())) > 0;) {
    text.append(piece.data(), static_cast<std::size_t>(size));
  }
  close(ends[0]);
  waitpid(pid, &status, 0);
  return text;
}
std::string said(SpawnPlan& plan, const std::string& line) {
  int status = 0;
  std::string text = said(plan, line, status);
  EXPECT_EQ(status, 0);
  return text;
}

const std::string kGroupIsOwn = "test $(ps -o pgid= -p $$) = $$ && echo own || echo shared";

TEST(SpawnPlanTest, AProgramInheritsWhatThePlanDoesNotChange) {
  SpawnPlan plan;
  EXPECT_EQ(said(plan, kGroupIsOwn), "shared\n");
}

TEST(SpawnPlanTest, AProgramHasAGroupOfItsOwn) {
  SpawnPlan plan;
  EXPECT_EQ(said(plan.own_group(), kGroupIsOwn), "own\n");
}

TEST(SpawnPlanTest, AFileThatGivesNothingIsAtItsEndAndTakesEverything) {
  SpawnPlan plan;
  plan.give_nothing(STDIN_FILENO).give_nothing(STDERR_FILENO);
  EXPECT_EQ(said(plan, "cat && echo lost >&2 && echo end"), "end\n");
}

TEST(SpawnPlanTest, AProgramGetsNoFileFromTheOneOnWhichIsClosed) {
  const int null = open("/dev/null", O_RDONLY);
  const int file = fcntl(null, F_DUPFD, 100);  // above those that the program is given
  close(null);
  const std::string is_open =
      "test -e /proc/$$/fd/" + std::to_string(file) + " && echo open || echo no";
  SpawnPlan as_here, closed;
  EXPECT_EQ(said(as_here, is_open), "open\n");
  EXPECT_EQ(said(closed.close_from(file), is_open), "no\n");
  close(file);
}

TEST(SpawnPlanTest, AProgramRunsInItsFolder) {
  SpawnPlan plan;
  EXPECT_EQ(said(plan.in_folder("/usr"), "pwd"), "/usr\n");
}

TEST(SpawnPlanTest, ASignalThatIsIgnoredHereReachesAProgramWithDefaultSignals) {
  const std::string raise = "kill -HUP $$; echo survived";
  const auto before = std::signal(SIGHUP, SIG_IGN);
  SpawnPlan as_here, by_default;
  EXPECT_EQ(said(as_here, raise), "survived\n");
  int status = 0;
  EXPECT_EQ(said(by_default.default_signals(), raise, status), "");
  EXPECT_TRUE(WIFSIGNALED(status));
  EXPECT_EQ(WTERMSIG(status), SIGHUP);
  std::signal(SIGHUP, before);
}

TEST(SpawnPlanTest, ASignalThatIsBlockedHereReachesAProgramWhoseSignalsAreUnblocked) {
  const std::string raise = "kill -USR1 $$; echo survived";
  sigset_t blocked, before;
  sigemptyset(&blocked);
  sigaddset(&blocked, SIGUSR1);
  pthread_sigmask(SIG_BLOCK, &blocked, &before);
  SpawnPlan as_here, unblocked;
  EXPECT_EQ(said(as_here, raise), "survived\n");
  int status = 0;
  EXPECT_EQ(said(unblocked.unblock_signals(), raise, status), "");
  EXPECT_TRUE(WIFSIGNALED(status));
  EXPECT_EQ(WTERMSIG(status), SIGUSR1);
  pthread_sigmask(SIG_SETMASK, &before, nullptr);
}

TEST(SpawnPlanTest, AnEnvironmentThatIsGivenIsTheOnlyOne) {
  pid_t pid = 0;
  int status = 0;
  const std::string line = "test \"$WORD\" = yes && test -z \"$HOME\"";
  ASSERT_EQ(SpawnPlan{}.start("/bin/sh", {"sh", "-c", line}, pid, {"WORD=yes"}), 0);
  waitpid(pid, &status, 0);
  EXPECT_EQ(status, 0);
}

TEST(SpawnPlanTest, AProgramThatIsNotThereIsAnError) {
  pid_t pid = 0;
  EXPECT_EQ(SpawnPlan{}.start("/nowhere/program", {"program"}, pid), ENOENT);
}

}  // namespace
}  // namespace armature
