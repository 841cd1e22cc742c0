// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "armature/bus/network_interface.hpp"

namespace armature::doctor {

// What a machine is, before anybody says whether that is good. An empty reason: it went well.

/// Where Fast DDS puts what processes of one machine share.
struct SharedMemoryFacts {
  std::string folder = "/dev/shm";
  std::string unusable;                          // why nothing can be written there
  std::uint64_t free_bytes = 0;                  // when something can
  std::vector<std::filesystem::path> left_over;  // by processes of this user that are dead
};

/// A soft limit of this process; nothing: there is none.
using Limit = std::optional<std::uint64_t>;

struct RightsFacts {
  Limit memlock_bytes, rtprio, nofile;
  std::string priority_refused;  // why a thread may not run with SCHED_FIFO 80
  std::string memory_refused;    // why memory cannot be locked
};

struct KernelFacts {
  std::string release;                 // "6.1.0-18-rt-amd64"
  bool real_time = false;              // PREEMPT_RT
  int processors = 0;                  // that this process may use
  std::vector<std::string> governors;  // each once; none when the system does not tell
};

struct NetworkFacts {
  std::vector<NetworkInterface> interfaces;
  std::string multicast_lost;  // why a datagram to a group on loopback does not come back
  /// What a socket may keep at most until it is read [B]; nothing: the system does not tell.
  std::optional<std::uint64_t> max_receive_buffer = {};
};

struct ClockFacts {
  std::int64_t resolution_ns = 0;  // of the monotonic clock
  bool synchronised = false;       // the system clock, with a better one
  double max_error_s = 0;          // of it, as the kernel estimates
};

struct UnusablePlugin {
  std::filesystem::path file;
  std::string reason;
};

struct PluginFacts {
  std::vector<std::filesystem::path> folders;  // in the order of search
  std::vector<std::string> warnings;           // of folders and ids
  int usable = 0;
  std::vector<UnusablePlugin> unusable;
};

struct Version {
  std::string of, number;
};

struct Facts {
  SharedMemoryFacts shared_memory;
  RightsFacts rights;
  KernelFacts kernel;
  NetworkFacts network;
  ClockFacts clock;
  PluginFacts plugins;
  std::vector<Version> versions;
};

}  // namespace armature::doctor
