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
#include <utility>

#include "armature/values/file_content.hpp"
#include "armature/values/spawn_plan.hpp"

namespace armature::bench {
namespace {

/// In the environment of what a bench starts: the bench's process number.
constexpr const char* kBench = "ARMATURE_BENCH";

/// Where the process may write to. Throws std::system_error.
int open_output(const std::filesystem::path& output, const char* ending) {
  const std::string file = output.empty() ? "/dev/null" : output.string() + ending;
  const int opened = open(file.c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, 0600);
  if (opened < 0) throw std::system_error(errno, std::generic_category(), file);
  return opened;
}

}  // namespace

void end_with_bench() {
  const char* bench = std::getenv(kBench);
  if (!bench) return;
  prctl(PR_SET_PDEATHSIG, SIGTERM);
  if (std::to_string(getppid()) != bench) raise(SIGTERM);  // it has ended before
}

Program::Program(std::vector<std::string> words, std::filesystem::path output)
    : output_{std::move(output)} {
  const int out = open_output(output_, ".out"), err = open_output(output_, ".err");
  SpawnPlan plan;
  plan.give_nothing(STDIN_FILENO).hand_over(out, STDOUT_FILENO).hand_over(err, STDERR_FILENO);
  plan.close_from(STDERR_FILENO + 1).default_signals().unblock_signals();
  words.insert(words.begin(), "armature");
  std::vector<std::string> environment{std::string{kBench} + "=" + std::to_string(getpid())};
  for (char** entry = environ; *entry; ++entry) environment.emplace_back(*entry);
  const int error = plan.start("/proc/self/exe", std::move(words), pid_, std::move(environment));
  for (const int file : {out, err}) close(file);
  if (error == 0) return;
  throw std::system_error(error, std::generic_category(), "cannot start another process");
}

Program::~Program() {
  constexpr int kTimeout_ms = 3000;
  if (!has_ended()) kill(pid_, SIGTERM);
  for (int i = 0; i < kTimeout_ms && !has_ended(); ++i) usleep(1000);
  if (!has_ended()) kill(pid_, SIGKILL);
  wait();
}

std::string Program::out() const { return content_of(output_.string() + ".out"); }
std::string Program::err() const { return content_of(output_.string() + ".err"); }

void Program::interrupt() {
  if (!has_ended()) kill(pid_, SIGINT);
  wait();
}

bool Program::has_ended() {
  ended_ = ended_ || waitpid(pid_, nullptr, WNOHANG) == pid_;
  return ended_;
}

void Program::wait() {
  while (!ended_) {
    ended_ = waitpid(pid_, nullptr, 0) == pid_ || errno != EINTR;
  }
}

}  // namespace armature::bench
