// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <sys/types.h>

#include <filesystem>
#include <string>
#include <vector>

namespace armature::bench {

/// This program again, with other words, as a process of its own. It is killed with this object; it
/// can tell that this process is gone by the end of its input.
class Program {
 public:
  /// "topic", "hz", ...; with `output`, what it prints goes to that file with ".out" and ".err"
  /// added, else nowhere. Throws std::system_error when it cannot be started.
  explicit Program(std::vector<std::string> words, const std::filesystem::path& output = {});
  ~Program();
  Program(const Program&) = delete;
  Program& operator=(const Program&) = delete;

  pid_t pid() const { return pid_; }
  /// As Ctrl-C does.
  void interrupt() const;
  /// Waits for the end. The exit code, or 128 and the number of the signal.
  int wait();

 private:
  pid_t pid_ = 0;
  bool ended_ = false;
  int input_ = -1;  // the end that we hold
};

}  // namespace armature::bench
