// SPDX-License-Identifier: Apache-2.0
#include "bench/program.hpp"

#include <fcntl.h>
#include <sys/prctl.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cerrno>
#include <csignal>
#include <cstdlib>
#include <system_error>

#include "armature/values/spawn_plan.hpp"

namespace armature::bench {
namespace {

/// Where the process may write to. Throws std::system_error.
int open_output(const std::filesystem::path& output, const char* ending) {
  const std::string file = output.empty() ? "/dev/null" : output.string() + ending;
  const int opened = open(file.c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, 0600);
  if (opened < 0) throw std::system_error(errno, std::generic_category(), file);
  return opened;
}

}  // namespace

Program::Program(std::vector<std::string> words, const std::filesystem::path& output) {
  int ends[2];
  if (pipe2(ends, O_CLOEXEC) != 0) throw std::system_error(errno, std::generic_category(), "pipe");
  input_ = ends[1];
  const int out = open_output(output, ".out"), err = open_output(output, ".err");
  SpawnPlan plan;
  plan.hand_over(ends[0], STDIN_FILENO).hand_over(out, STDOUT_FILENO).hand_over(err, STDERR_FILENO);
  plan.close_from(STDERR_FILENO + 1);
  plan.default_signals().unblock_signals();
  words.insert(words.begin(), "armature");
  std::vector<std::string> environment{std::string{kEndsWithStarter} + "=" +
                                       std::to_string(getpid())};
  for (char** entry = environ; *entry; ++entry) environment.emplace_back(*entry);
  const int error = plan.start("/proc/self/exe", std::move(words), pid_, std::move(environment));
  for (const int file : {ends[0], out, err}) close(file);
  if (error == 0) return;
  close(input_);
  throw std::system_error(error, std::generic_category(), "cannot start another process");
}

void end_with_starter() {
  const char* starter = std::getenv(kEndsWithStarter);
  if (!starter) return;
  prctl(PR_SET_PDEATHSIG, SIGTERM);
  if (std::to_string(getppid()) != starter) raise(SIGTERM);  // it has ended before
}

Program::~Program() {
  constexpr int kTimeout_ms = 3000;
  if (!has_ended()) kill(pid_, SIGTERM);
  for (int i = 0; i < kTimeout_ms && !has_ended(); ++i) usleep(1000);
  if (!has_ended()) kill(pid_, SIGKILL);
  wait();
  close(input_);
}

void Program::interrupt() const { kill(pid_, SIGINT); }

bool Program::has_ended() {
  int status = 0;
  if (ended_ || waitpid(pid_, &status, WNOHANG) != pid_) return ended_;
  code_ = WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
  return ended_ = true;
}

int Program::wait() {
  int status = 0;
  while (!ended_ && waitpid(pid_, &status, 0) != pid_) {
    if (errno != EINTR) break;
  }
  if (!ended_) code_ = WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
  ended_ = true;
  return code_;
}

}  // namespace armature::bench
