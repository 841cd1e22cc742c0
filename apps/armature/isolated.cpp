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

/// Reads until the other end is closed; false when that takes too long.
bool read_all(int from, double timeout_s, std::string& text) {
  using Clock = std::chrono::steady_clock;
  const auto end = Clock::now() + std::chrono::duration<double>{timeout_s};
  for (std::array<char, 4096> buffer;;) {
    const auto left = std::chrono::duration_cast<std::chrono::milliseconds>(end - Clock::now());
    if (left.count() <= 0) return false;
    pollfd ready{from, POLLIN, 0};
    if (poll(&ready, 1, static_cast<int>(left.count()) + 1) <= 0) continue;
    const ssize_t n = ::read(from, buffer.data(), buffer.size());
    if (n == 0) return true;
    if (n > 0) text.append(buffer.data(), static_cast<std::size_t>(n));
  }
}

}  // namespace

Isolated isolated(double timeout_s, const std::function<std::string()>& work) {
  std::array<int, 2> ends{};
  if (pipe2(ends.data(), O_CLOEXEC) != 0) throw std::runtime_error("cannot make a pipe");
  std::fflush(nullptr);
  const pid_t child = fork();
  if (child < 0) throw std::runtime_error(fmt::format("cannot fork: {}", std::strerror(errno)));
  if (child == 0) work_and_exit(ends[1], work);
  close(ends[1]);
  Isolated outcome;
  const bool in_time = read_all(ends[0], timeout_s, outcome.result);
  close(ends[0]);
  if (!in_time) kill(child, SIGKILL);
  int status = 0;
  while (waitpid(child, &status, 0) < 0 && errno == EINTR) {
  }
  if (!in_time) {
    outcome.fault = fmt::format("not done after {:g} s", timeout_s);
  } else if (WIFSIGNALED(status)) {
    outcome.fault =
        fmt::format("killed by signal {} ({})", WTERMSIG(status), strsignal(WTERMSIG(status)));
  } else if (WEXITSTATUS(status) != 0) {
    outcome.fault = fmt::format("it ends the process (exit code {})", WEXITSTATUS(status));
  }
  return outcome;
}

}  // namespace armature
