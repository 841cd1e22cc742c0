// SPDX-License-Identifier: Apache-2.0
#include "doctor/gather.hpp"

#include <arpa/inet.h>
#include <fmt/format.h>
#include <netinet/in.h>
#include <poll.h>
#include <sched.h>
#include <sys/resource.h>
#include <sys/socket.h>
#include <sys/timex.h>
#include <sys/utsname.h>
#include <unistd.h>

#include <Eigen/Core>
#include <algorithm>
#include <cerrno>
#include <cstring>
#include <ctime>
#include <fstream>
#include <memory>

#include "armature/bus/fast_dds/shared_memory.hpp"
#include "armature/runtime/execution/real_time_thread.hpp"
#include "isolated.hpp"

namespace armature::doctor {
namespace {

constexpr double kTimeout_s = 5;

SharedMemoryFacts shared_memory_facts() {
  SharedMemoryFacts facts;
  const SharedMemory memory;
  facts.folder = memory.folder;
  if (const auto usable = check_shared_memory(memory, 0); !usable) {
    facts.unusable = usable.error().text;
    return facts;
  }
  facts.free_bytes = memory.free_bytes(memory.folder).value_or(0);
  facts.left_over = left_in_shared_memory(memory.folder);
  return facts;
}

/// `resource` as getrlimit() takes it.
template <class Resource>
Limit limit_of(Resource resource) {
  rlimit limit{};
  if (getrlimit(resource, &limit) != 0 || limit.rlim_cur == RLIM_INFINITY) return std::nullopt;
  return limit.rlim_cur;
}

/// What a child says of `work`, or why it did not say anything.
template <class Work>
std::string said_by_child(const Work& work) {
  const Isolated tried = isolated(kTimeout_s, work);
  return tried.fault.empty() ? tried.result : tried.fault;
}

RightsFacts rights_facts() {
  RightsFacts facts;
  facts.memlock_bytes = limit_of(RLIMIT_MEMLOCK);
  facts.rtprio = limit_of(RLIMIT_RTPRIO);
  facts.nofile = limit_of(RLIMIT_NOFILE);
  facts.priority_refused = said_by_child([]() -> std::string {
    const sched_param wanted{.sched_priority = 80};
    return sched_setscheduler(0, SCHED_FIFO, &wanted) == 0 ? "" : std::strerror(errno);
  });
  facts.memory_refused = said_by_child(lock_process_memory);
  return facts;
}

std::string first_line(const std::filesystem::path& file) {
  std::string line;
  std::getline(std::ifstream{file} >> std::ws, line);
  return line;
}

/// How the speed of the processors is chosen: of each of them, once.
std::vector<std::string> governors() {
  std::vector<std::string> all;
  std::error_code error;
  for (const auto& entry : std::filesystem::directory_iterator{"/sys/devices/system/cpu", error}) {
    std::string governor = first_line(entry.path() / "cpufreq" / "scaling_governor");
    if (!governor.empty()) all.push_back(std::move(governor));
  }
  std::ranges::sort(all);
  all.erase(std::ranges::unique(all).begin(), all.end());
  return all;
}

KernelFacts kernel_facts() {
  KernelFacts facts;
  if (utsname names{}; uname(&names) == 0) {
    facts.release = names.release;
    facts.real_time = std::string_view{names.version}.find("PREEMPT_RT") != std::string_view::npos;
  }
  if (first_line("/sys/kernel/realtime") == "1") facts.real_time = true;
  cpu_set_t set;
  CPU_ZERO(&set);
  facts.processors = sched_getaffinity(0, sizeof set, &set) == 0 ? CPU_COUNT(&set) : 1;
  facts.governors = governors();
  return facts;
}

/// Sends a datagram to the group of DDS discovery over loopback, to a port that is free, and waits
/// for it. Returns why it did not come.
std::string multicast_over_loopback() {
  const auto failed = [](const char* what) {
    return fmt::format("{}: {}", what, std::strerror(errno));
  };
  const int asks = socket(AF_INET, SOCK_DGRAM | SOCK_CLOEXEC, 0);
  if (asks < 0) return failed("no socket");
  const std::unique_ptr<const int, void (*)(const int*)> closes{&asks,
                                                                [](const int* fd) { close(*fd); }};
  const in_addr loopback{htonl(INADDR_LOOPBACK)};
  const ip_mreq membership{.imr_multiaddr = {inet_addr("239.255.0.1")}, .imr_interface = loopback};
  if (setsockopt(asks, IPPROTO_IP, IP_ADD_MEMBERSHIP, &membership, sizeof membership) != 0) {
    return failed("the group cannot be joined");
  }
  if (setsockopt(asks, IPPROTO_IP, IP_MULTICAST_IF, &loopback, sizeof loopback) != 0) {
    return failed("loopback cannot be sent over");
  }
  sockaddr_in address{};
  address.sin_family = AF_INET;
  socklen_t size = sizeof address;
  if (bind(asks, reinterpret_cast<sockaddr*>(&address), size) != 0 ||
      getsockname(asks, reinterpret_cast<sockaddr*>(&address), &size) != 0) {
    return failed("no port");
  }
  address.sin_addr = membership.imr_multiaddr;
  if (sendto(asks, "?", 1, 0, reinterpret_cast<sockaddr*>(&address), size) != 1) {
    return failed("nothing can be sent");
  }
  pollfd ready{asks, POLLIN, 0};
  return poll(&ready, 1, 1000) == 1 ? "" : "what was sent did not come back within 1 s";
}

std::optional<std::uint64_t> max_receive_buffer() {
  std::uint64_t bytes = 0;
  if (std::ifstream{"/proc/sys/net/core/rmem_max"} >> bytes) return bytes;
  return std::nullopt;
}

ClockFacts clock_facts() {
  ClockFacts facts;
  timespec resolution{};
  clock_getres(CLOCK_MONOTONIC, &resolution);
  facts.resolution_ns = std::int64_t{resolution.tv_sec} * 1'000'000'000 + resolution.tv_nsec;
  timex state{};  // modes 0: only asked
  const int answer = adjtimex(&state);
  facts.synchronised = answer >= 0 && answer != TIME_ERROR && (state.status & STA_UNSYNC) == 0;
  facts.max_error_s = static_cast<double>(state.maxerror) * 1e-6;
  return facts;
}

std::vector<Version> versions() {
  return {{"armature", ARMATURE_VERSION},
          {"Fast DDS", ARMATURE_FAST_DDS_VERSION},
          {"Eigen",
           fmt::format("{}.{}.{}", EIGEN_WORLD_VERSION, EIGEN_MAJOR_VERSION, EIGEN_MINOR_VERSION)}};
}

}  // namespace

Facts facts_of_this_machine() {
  return {.shared_memory = shared_memory_facts(),
          .rights = rights_facts(),
          .kernel = kernel_facts(),
          .network = {network_interfaces(), multicast_over_loopback(), max_receive_buffer()},
          .clock = clock_facts(),
          .plugins = plugin_facts(),
          .versions = versions()};
}

}  // namespace armature::doctor
