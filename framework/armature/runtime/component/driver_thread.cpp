// SPDX-License-Identifier: Apache-2.0
#include "armature/runtime/component/driver_thread.hpp"

#include <poll.h>
#include <pthread.h>
#include <sys/eventfd.h>
#include <unistd.h>

#include <cerrno>
#include <csignal>
#include <system_error>

#include "armature/runtime/plugins/running_component.hpp"
#include "armature/runtime/plugins/setup_error.hpp"

namespace armature {
namespace {

/// Only signals of a crash reach the calling thread: an operator's Ctrl-C must not cut a read
/// short.
void block_signals() {
  sigset_t blocked;
  sigfillset(&blocked);
  for (const int crash : {SIGSEGV, SIGBUS, SIGFPE, SIGILL, SIGABRT, SIGTRAP}) {
    sigdelset(&blocked, crash);
  }
  pthread_sigmask(SIG_SETMASK, &blocked, nullptr);
}

}  // namespace

DriverThread::DriverThread(std::function<void()> body)
    : body_{std::move(body)}, stop_descriptor_{eventfd(0, EFD_CLOEXEC)} {
  if (stop_descriptor_ < 0) {
    throw std::system_error{errno, std::generic_category(), "a driver thread has no event"};
  }
}

DriverThread::~DriverThread() {
  join();
  close(stop_descriptor_);
}

bool DriverThread::sleep_for(Duration duration) const {
  using Steady = std::chrono::steady_clock;
  const auto end = Steady::now() + duration;
  while (!stopping()) {
    const Duration left = end - Steady::now();
    if (left <= Duration{0}) return true;
    constexpr std::int64_t kSecond = 1'000'000'000;
    const timespec timeout{.tv_sec = left.count() / kSecond, .tv_nsec = left.count() % kSecond};
    pollfd stop{.fd = stop_descriptor_, .events = POLLIN, .revents = 0};
    ppoll(&stop, 1, &timeout, nullptr);
  }
  return false;
}

void DriverThread::start(const std::string& component, Links links) {
  links_ = std::move(links);
  thread_ = std::thread{[this, &component] {
    run(component);
    end_.set_value();
  }};
}

void DriverThread::run(const std::string& component) {
  constexpr std::size_t kMaxThreadName = 15;
  pthread_setname_np(pthread_self(), component.substr(0, kMaxThreadName).c_str());
  block_signals();
  const CrashStack crash_stack;
  const RunningComponent running{component, "driver thread"};
  try {
    body_();
  } catch (...) {
    links_.fault(current_exception_text());
  }
}

void DriverThread::request_stop() {
  stopping_.store(true, std::memory_order_release);
  eventfd_write(stop_descriptor_, 1);
}

bool DriverThread::join_until(std::chrono::steady_clock::time_point end) {
  if (!thread_.joinable()) return true;
  if (ended_.wait_until(end) != std::future_status::ready) return false;
  thread_.join();
  return true;
}

void DriverThread::join() {
  request_stop();
  if (thread_.joinable()) thread_.join();
}

}  // namespace armature
