// SPDX-License-Identifier: Apache-2.0
// What a program is to the system: its files, its signals, its end.
#include "program.hpp"

#include <gtest/gtest.h>

#include <csignal>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <set>
#include <sstream>
#include <thread>

namespace armature::ik::process {
namespace {

constexpr double kTimeout_s = 60;

std::unique_ptr<Program> shell(const std::string& script, const std::string& folder = "") {
  const auto command = find_command({"sh", "-c", script}, folder);
  auto program = Program::start(command.value());
  if (!program) throw std::runtime_error(program.error().text);
  return std::move(*program);
}

/// Gone, or waiting for its parent to notice.
bool ends(pid_t pid) {
  for (int i = 0; i < 2000; ++i) {
    std::ifstream stat{"/proc/" + std::to_string(pid) + "/stat"};
    std::string number, name, state;
    if (!(stat >> number >> name >> state) || state == "Z") return true;
    std::this_thread::sleep_for(std::chrono::milliseconds{10});
  }
  return false;
}

TEST(Program, AnswersEachLineWithALine) {
  const auto echo = shell("while read -r line; do echo \"$line!\"; done");
  EXPECT_EQ(echo->ask("one", kTimeout_s).value(), "one!");
  EXPECT_EQ(echo->ask("two words", kTimeout_s).value(), "two words!");
}

TEST(Program, AnswersAQuestionThatIsLongerThanAnyBuffer) {
  const auto count = shell("read -r line; echo ${#line}");
  EXPECT_EQ(count->ask(std::string(300000, 'x'), kTimeout_s).value(), "300000");
}

TEST(Program, IsAskedInVainWhenItIsGoneAndWeAreNotKilledForIt) {
  const auto once = shell("read -r line; echo bye; exec 0<&-");
  EXPECT_EQ(once->ask("one", kTimeout_s).value(), "bye");
  ASSERT_TRUE(ends(once->pid()));
  EXPECT_EQ(once->ask("two", kTimeout_s).error().text, "ended with exit code 0");
  EXPECT_EQ(once->ask("three", kTimeout_s).error().text, "ended with exit code 0");
}

TEST(Program, RunsInItsFolder) {
  const std::string folder = std::filesystem::canonical("/usr/bin").string();
  EXPECT_EQ(shell("read -r line; pwd -P", folder)->ask("", kTimeout_s).value(), folder);
}

TEST(Program, IsFoundFromTheFolderWhenItsNameHasASlash) {
  const auto command = find_command({"bin/sh"}, "/");
  ASSERT_TRUE(command) << command.error().text;
  EXPECT_EQ(command->file, "/bin/sh");
}

TEST(Program, HasNoOpenFileButItsStandardOnes) {
  for (const auto& file : std::filesystem::directory_iterator{"/proc/self/fd"}) {
    const int fd = std::stoi(file.path().filename().string());
    if (fd > STDERR_FILENO) fcntl(fd, F_SETFD, FD_CLOEXEC);  // what others have left open
  }
  const auto first = shell("read -r line; echo");
  const auto second = shell("read -r line; echo /proc/self/fd/*");
  std::istringstream files{second->ask("", kTimeout_s).value()};
  const std::set<std::string> seen{std::istream_iterator<std::string>{files}, {}};
  EXPECT_TRUE(seen.contains("/proc/self/fd/0"));
  EXPECT_LE(seen.size(), 4U) << "three, and the folder that is looked at";
}

TEST(Program, DoesNotInheritTheSignalsThatWeBlockOrIgnore) {
  sigset_t blocked, before;
  sigemptyset(&blocked);
  sigaddset(&blocked, SIGTERM);
  pthread_sigmask(SIG_BLOCK, &blocked, &before);
  const auto handler = std::signal(SIGPIPE, SIG_IGN);
  const auto shown =
      shell("read -r line; echo $(sed -n 's/SigBlk:\\|SigIgn://p' /proc/self/status)");
  std::istringstream masks{shown->ask("", kTimeout_s).value()};
  std::signal(SIGPIPE, handler);
  pthread_sigmask(SIG_SETMASK, &before, nullptr);
  constexpr std::uint64_t kOfTheLibrary = 0b11ULL << 31;  // 32 and 33, which nobody may set
  std::uint64_t blocked_there = 1, ignored_there = 1;
  masks >> std::hex >> blocked_there >> ignored_there;
  EXPECT_EQ(blocked_there & ~kOfTheLibrary, 0U) << masks.str();
  EXPECT_EQ(ignored_there & ~kOfTheLibrary, 0U) << masks.str();
}

TEST(Program, EndsWithUsAndWithWhatItHasStarted) {
  auto parent = shell("sleep 3600 & read -r line; echo $!; wait");
  const pid_t child = std::stoi(parent->ask("", kTimeout_s).value());
  const pid_t pid = parent->pid();
  parent.reset();
  EXPECT_TRUE(ends(child));
  EXPECT_TRUE(ends(pid));
}

TEST(Program, ThatDoesNotHeedTheEndOfItsInputIsKilled) {
  auto stubborn = shell("trap '' TERM INT HUP; read -r line; echo; while :; do sleep 1; done");
  stubborn->ask("", kTimeout_s).value();
  const pid_t pid = stubborn->pid();
  stubborn.reset();
  EXPECT_TRUE(ends(pid));
}

TEST(Program, LivesOnWhenTheThreadThatStartedItEnds) {
  std::unique_ptr<Program> echo;
  std::jthread{[&] { echo = shell("while read -r line; do echo \"$line!\"; done"); }}.join();
  EXPECT_EQ(echo->ask("one", kTimeout_s).value(), "one!");
}

}  // namespace
}  // namespace armature::ik::process
