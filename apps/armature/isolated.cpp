// SPDX-License-Identifier: Apache-2.0
#include "isolated.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <poll.h>
#include <sys/prctl.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <chrono>
#include <csignal>
#include <cstdio>
#include <cstring>
#include <exception>
#include <memory>
#include <stdexcept>
#include <thread>
#include <vector>

#include "armature/runtime/plugins/exit_guard.hpp"
#include "armature/values/time.hpp"

namespace armature {
namespace {

// The last byte that the process writes: without one it was ended by its work.
constexpr char kResult = 'r', kFault = 'f';

/// True when all of it was written.
bool tell(int to, std::string text, char last) {
  text += last;
  for (std::size_t written = 0; written < text.size();) {
    const ssize_t n = write(to, text.data() + written, text.size() - written);
    if (n < 0 && errno != EINTR) return false;
    if (n > 0) written += static_cast<std::size_t>(n);
  }
  return true;
}

[[noreturn]] void work_and_exit(int to, const std::function<std::string()>& work) {
  prctl(PR_SET_PDEATHSIG, SIGKILL);
  const int nowhere = open("/dev/null", O_WRONLY | O_CLOEXEC);
  dup2(nowhere, STDOUT_FILENO);
  const ExitGuard guard{[to](const std::string& what) { tell(to, what, kFault); }};
  try {
    _exit(tell(to, work(), kResult) ? 0 : 1);
  } catch (const std::exception& error) {
    std::fprintf(stderr, "armature: %s\n", error.what());
    _exit(1);
  }
}

int wait_for(pid_t child) {
  int status = 0;
  while (waitpid(child, &status, 0) < 0 && errno == EINTR) {
  }
  return status;
}

}  // namespace

IsolatedWork::IsolatedWork(double timeout_s, const std::function<std::string()>& work)
    : timeout_s_{timeout_s}, end_{Clock::now() + seconds(timeout_s)} {
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
  Isolated outcome;
  const char last = result_.empty() ? '\0' : result_.back();
  if (told_all_ && last == kResult && WIFEXITED(status)) {
    result_.pop_back();
    outcome.result = result_;
  } else if (told_all_ && last == kFault) {
    result_.pop_back();
    outcome.fault = result_;
  } else if (!told_all_) {
    outcome.fault = fmt::format("not done after {:g} s", timeout_s_);
    outcome.timed_out = true;
  } else if (WIFSIGNALED(status)) {
    outcome.fault =
        fmt::format("killed by signal {} ({})", WTERMSIG(status), strsignal(WTERMSIG(status)));
  } else {
    outcome.fault = fmt::format("it ends the process (exit code {})", WEXITSTATUS(status));
  }
  return outcome;
}

Isolated isolated(double timeout_s, const std::function<std::string()>& work) {
  Isolated only;
  isolated_each(
      1, 1, timeout_s, [&](std::size_t) { return work(); },
      [&](std::size_t, const Isolated& outcome) { only = outcome; });
  return only;
}

void isolated_each(std::size_t count, std::size_t at_once, double timeout_s,
                   const std::function<std::string(std::size_t)>& work,
                   const std::function<void(std::size_t, const Isolated&)>& take) {
  constexpr int kLongestWait_ms = 100;
  struct Running {
    std::size_t index;
    std::unique_ptr<IsolatedWork> work;
  };
  std::vector<Running> running;
  for (std::size_t next = 0; next < count || !running.empty();) {
    for (; next < count && running.size() < at_once; ++next) {
      running.push_back(
          {next, std::make_unique<IsolatedWork>(timeout_s, [&] { return work(next); })});
    }
    std::vector<pollfd> ready;
    for (const Running& one : running) ready.push_back({one.work->descriptor(), POLLIN, 0});
    poll(ready.data(), ready.size(), kLongestWait_ms);
    std::erase_if(running, [&](Running& one) {
      if (!one.work->is_over()) return false;
      take(one.index, one.work->outcome());
      return true;
    });
  }
}

std::size_t processors() { return std::max(1u, std::thread::hardware_concurrency()); }

}  // namespace armature
