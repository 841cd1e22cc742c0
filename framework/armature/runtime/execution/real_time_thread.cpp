// SPDX-License-Identifier: Apache-2.0
#include "armature/runtime/execution/real_time_thread.hpp"

#include <fmt/format.h>
#include <linux/capability.h>
#include <pthread.h>
#include <sched.h>
#include <sys/mman.h>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <sys/syscall.h>
#include <unistd.h>

#include <cerrno>
#include <cstddef>
#include <cstdint>
#include <cstring>

namespace armature {
namespace {

[[gnu::noinline]] void touch_stack() {
  constexpr std::size_t kPage = 4096;
  volatile std::uint8_t pages[64 * kPage];
  for (std::size_t at = 0; at < sizeof pages; at += kPage) pages[at] = 0;
}

/// Whether the process may lock more than its limit.
bool may_lock_all() {
  __user_cap_header_struct header{.version = _LINUX_CAPABILITY_VERSION_3, .pid = 0};
  __user_cap_data_struct data[2] = {};
  return syscall(SYS_capget, &header, data) == 0 && (data[0].effective & (1U << CAP_IPC_LOCK)) != 0;
}

}  // namespace

std::vector<std::string> prepare_thread(const ThreadSettings& settings) {
  std::vector<std::string> refused;
  pthread_setname_np(pthread_self(), settings.name.substr(0, 15).c_str());
  if (settings.cpu) {
    cpu_set_t set;
    CPU_ZERO(&set);
    CPU_SET(static_cast<std::size_t>(*settings.cpu), &set);
    if (const int error = pthread_setaffinity_np(pthread_self(), sizeof set, &set)) {
      refused.push_back(
          fmt::format("is not pinned to cpu {}: {}", *settings.cpu, std::strerror(error)));
    }
  }
  if (settings.priority > 0) {
    const sched_param parameters{.sched_priority = settings.priority};
    if (const int error = pthread_setschedparam(pthread_self(), SCHED_FIFO, &parameters)) {
      refused.push_back(
          fmt::format("runs without priority {}: {}", settings.priority, std::strerror(error)));
    }
  }
  if (settings.has_period) prctl(PR_SET_TIMERSLACK, 1UL, 0UL, 0UL, 0UL);
  touch_stack();
  return refused;
}

std::string lock_process_memory() {
  rlimit limit{};
  getrlimit(RLIMIT_MEMLOCK, &limit);
  // Under a limit that is enough for now, memory that is asked for later is refused.
  if (limit.rlim_cur != RLIM_INFINITY && !may_lock_all()) {
    return fmt::format(
        "the limit is {} KiB; raise it (ulimit -l unlimited, or 'memlock' in "
        "/etc/security/limits.conf)",
        limit.rlim_cur / 1024);
  }
  if (mlockall(MCL_CURRENT | MCL_FUTURE) == 0) return {};
  return std::strerror(errno);
}

}  // namespace armature
