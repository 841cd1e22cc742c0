// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <sys/types.h>

#include <optional>
#include <string>
#include <vector>

namespace armature {

/// The other processes of a deployment, started by the main one and ended with it (by the kernel,
/// when the main one is killed).
class ChildProcesses {
 public:
  ChildProcesses() = default;
  ChildProcesses(const ChildProcesses&) = delete;
  ChildProcesses& operator=(const ChildProcesses&) = delete;
  ~ChildProcesses() { stop(); }

  /// Runs this executable again with `arguments`. Throws std::system_error.
  void start(const std::string& name, const std::vector<std::string>& arguments);
  /// How one of them ended before it was asked to.
  struct Ending {
    bool well = false;  // with exit code 0: its part of the story has been told
    std::string text;   // "process 'vision' (pid 123) was killed (Killed)"
  };
  /// Once one has ended by itself.
  std::optional<Ending> ended();
  /// Asks all to end, and makes them after 3 s.
  void stop();

 private:
  struct Child {
    std::string name;
    pid_t pid;
  };
  std::vector<Child> children_;
};

}  // namespace armature
