// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <sys/types.h>

#include <filesystem>
#include <string>
#include <vector>

namespace armature::bench {

/// In the environment of a program that ends when its starter ends, which is the process of that
/// number.
inline constexpr const char* kEndsWithStarter = "ARMATURE_ENDS_WITH_STARTER";
/// Of such a program, at its beginning.
void end_with_starter();

/// This program again, with other words, as a process of its own. It ends in order with this
/// object, and with this process, however that ends.
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
  bool has_ended();
  /// Waits for the end. The exit code, or 128 and the number of the signal.
  int wait();

 private:
  pid_t pid_ = 0;
  bool ended_ = false;
  int code_ = 0;
  int input_ = -1;  // the end that we hold
};

}  // namespace armature::bench
