// SPDX-License-Identifier: Apache-2.0
#include "bench/program.hpp"

#include <fcntl.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cerrno>
#include <csignal>
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
  words.insert(words.begin(), "armature");
  const int error = plan.start("/proc/self/exe", std::move(words), pid_);
  for (const int file : {ends[0], out, err}) close(file);
  if (error == 0) return;
  close(input_);
  throw std::system_error(error, std::generic_category(), "cannot start another process");
}

Program::~Program() {
  if (!ended_) kill(pid_, SIGKILL);
  wait();
  close(input_);
}

void Program::interrupt() const { kill(pid_, SIGINT); }

int Program::wait() {
  if (ended_) return 0;
  int status = 0;
  while (waitpid(pid_, &status, 0) < 0 && errno == EINTR) {
  }
  ended_ = true;
  return WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
}

}  // namespace armature::bench
