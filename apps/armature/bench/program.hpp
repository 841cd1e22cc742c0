// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <sys/types.h>

#include <filesystem>
#include <string>
#include <vector>

namespace armature::bench {

/// Called first by every program: one that a bench has started asks the system to end it in order
/// when the bench ends, however that ends.
void end_with_bench();

/// This program again, with other words, as a process of its own. It ends in order with this
/// object, and with this process, however that ends.
class Program {
 public:
  /// "topic", "hz", ...; with `output`, what it prints goes to that file with ".out" and ".err"
  /// added, else nowhere. Throws std::system_error when it cannot be started.
  explicit Program(std::vector<std::string> words, std::filesystem::path output = {});
  ~Program();
  Program(const Program&) = delete;
  Program& operator=(const Program&) = delete;

  pid_t pid() const { return pid_; }
  /// What it has printed so far on standard output, and on standard error. Needs `output`.
  std::string out() const;
  std::string err() const;
  /// Interrupts it as Ctrl-C does, and waits for its end.
  void interrupt();
  bool has_ended();

 private:
  void wait();

  std::filesystem::path output_;
  pid_t pid_ = 0;
  bool ended_ = false;
};

}  // namespace armature::bench
