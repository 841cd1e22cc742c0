// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <sys/types.h>

#include <string>
#include <string_view>
#include <vector>

namespace armature ARMATURE_EXPORT {

/// The lock that a process of a deployment holds as long as it runs (instance_lock.hpp).
std::string lock_of_process(std::string_view deployment, int domain, std::string_view process);

/// A process of a deployment, on this machine.
struct RunningProcess {
  std::string deployment, process;
  pid_t pid;    // 0: not known
  bool halted;  // by a signal (SIGSTOP, Ctrl-Z) or a debugger: it does nothing until it goes on

  /// For humans: "process 'vision' of deployment 'dental_lamp' (pid 123)"; the main one is the
  /// deployment.
  std::string text() const;
};

/// Those of a DDS domain by their locks, whether they answer on DDS or not. One in another network
/// namespace (a container with a network of its own) is not seen.
std::vector<RunningProcess> running_processes(int domain);

}  // namespace armature
