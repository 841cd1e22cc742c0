// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <sys/types.h>

#include <memory>
#include <optional>
#include <string>
#include <string_view>

#include "command.hpp"
#include "error_relay.hpp"
#include "file_descriptor.hpp"

namespace armature::ik::process {

/// A running program that answers lines with lines. It has a process group of its own, which ends
/// with it; it inherits no open file but its standard ones, no signal that we ignore or block, and
/// not the real-time priority of the thread that starts it. Should we be killed, it reads the end
/// of its input.
class Program {
 public:
  static constexpr std::size_t kLongestAnswer = 65536;

  /// Refuses what the system will not start, with its reason.
  static Expected<std::unique_ptr<Program>> start(const Command& command);
  Program(const Program&) = delete;
  Program& operator=(const Program&) = delete;
  /// Closes its input and gives it 0.2 s to end before it is killed.
  ~Program();

  /// Writes `line` and returns the line that comes back; or what became of it, to be read behind
  /// the program's name: "gave no answer within 0.5 s", "ended with exit code 1; its last words:
  /// ...". After that its answers are out of step: end it.
  Expected<std::string> ask(std::string_view line, double timeout_s);

  pid_t pid() const { return pid_; }
  /// At once, if it still runs.
  void kill();

 private:
  Program(pid_t pid, FileDescriptor to, FileDescriptor from, ErrorRelay errors);

  std::optional<std::string> received_line();
  void send(std::string& unsent);
  bool receive();  // false: there will be no more
  bool has_ended() const;
  bool ends_within(double timeout_s) const;
  void end(double timeout_s);
  tl::unexpected<Reason> failed(std::string what);
  std::string fate();

  pid_t pid_;  // -1: ended
  FileDescriptor to_, from_;
  ErrorRelay errors_;
  std::string received_;
};

}  // namespace armature::ik::process
