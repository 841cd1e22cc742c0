// SPDX-License-Identifier: Apache-2.0
#include "isolated.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <poll.h>
#include <sys/prctl.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <chrono>
#include <csignal>
#include <cstdio>
#include <cstring>
#include <exception>
#include <stdexcept>

namespace armature {
namespace {

[[noreturn]] void work_and_exit(int to, const std::function<std::string()>& work) {
  prctl(PR_SET_PDEATHSIG, SIGKILL);
  const int nowhere = open("/dev/null", O_WRONLY | O_CLOEXEC);
  dup2(nowhere, STDOUT_FILENO);
  std::string result;
  try {
    result = work();
  } catch (const std::exception& error) {
    std::fprintf(stderr, "armature: %s\n", error.what());
    _exit(1);
  }
  for (std::size_t written = 0; written < result.size();) {
    const ssize_t n = write(to, result.data() + written, result.size() - written);
    if (n < 0 && errno != EINTR) _exit(1);
    if (n > 0) written += static_cast<std::size_t>(n);
  }
  _exit(0);
}

int wait_for(pid_t child) {
  int status = 0;
  while (waitpid(child, &status, 0) < 0 && errno == EINTR) {
  }
  return status;
}

}  // namespace

IsolatedWork::IsolatedWork(double timeout_s, const std::function<std::string()>& work)
    : timeout_s_{timeout_s},
      end_{Clock::now() +
           std::chrono::duration_cast<Clock::duration>(std::chrono::duration<double>{timeout_s})} {
  std::array<int, 2> ends{};
  if (pipe2(ends.data(), O_CLOEXEC) != 0) throw std::runtime_error("cannot make a pipe");
  fcntl(ends[0], F_SETFL, O_NONBLOCK);
  std::fflush(nullptr);
  child_ = fork();
  if (child_ == 0) work_and_exit(ends[1], work);
  close(ends[1]);
  from_ = ends[0];
  if (child_ >= 0) return;
  const int error = errno;
  close(from_);
  throw std::runtime_error(fmt::format("cannot fork: {}", std::strerror(error)));
}

IsolatedWork::~IsolatedWork() {
  close(from_);
  if (child_ < 0) return;
  kill(child_, SIGKILL);
  wait_for(child_);
}

bool IsolatedWork::is_over() {
  for (std::array<char, 4096> buffer; !told_all_;) {
    const ssize_t n = ::read(from_, buffer.data(), buffer.size());
    if (n < 0 && errno == EINTR) continue;
    if (n < 0) break;
    if (n == 0) told_all_ = true;
    result_.append(buffer.data(), static_cast<std::size_t>(n));
  }
  return told_all_ || Clock::now() >= end_;
}

Isolated IsolatedWork::outcome() {
  if (!told_all_) kill(child_, SIGKILL);
  const int status = wait_for(child_);
  child_ = -1;
  Isolated outcome{.result = result_, .fault = ""};
  if (!told_all_) {
    outcome.fault = fmt::format("not done after {:g} s", timeout_s_);
    outcome.timed_out = true;
  } else if (WIFSIGNALED(status)) {
    outcome.fault =
        fmt::format("killed by signal {} ({})", WTERMSIG(status), strsignal(WTERMSIG(status)));
  } else if (WEXITSTATUS(status) != 0) {
    outcome.fault = fmt::format("it ends the process (exit code {})", WEXITSTATUS(status));
  }
  return outcome;
}

Isolated isolated(double timeout_s, const std::function<std::string()>& work) {
  constexpr int kLongest_ms = 100;
  IsolatedWork running{timeout_s, work};
  while (!running.is_over()) {
    pollfd ready{running.descriptor(), POLLIN, 0};
    poll(&ready, 1, kLongest_ms);
  }
  return running.outcome();
}

}  // namespace armature
