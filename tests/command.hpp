// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <sys/types.h>

#include <chrono>
#include <map>
#include <string>
#include <vector>

namespace armature::test {

struct CommandResult {
  int exit_code = -1;  // 128 + signal when it was killed
  std::string out, err;
  bool timed_out = false;
};

/// A program in the background, killed when the test is over. Output goes to files.
class Command {
 public:
  struct Options {
    std::map<std::string, std::string> environment;  // added to ours
    std::string input;
  };

  Command(const std::vector<std::string>& arguments, const Options& options);
  explicit Command(const std::vector<std::string>& arguments) : Command(arguments, Options{}) {}
  Command(const Command&) = delete;
  Command& operator=(const Command&) = delete;
  ~Command();

  pid_t pid() const { return pid_; }
  /// A process that it has started; 0: none.
  pid_t child() const;
  void signal(int number) const;
  /// What it has printed so far.
  std::string out() const;
  std::string err() const;
  /// True once `text` has been printed on standard error.
  bool wait_for_err(const std::string& text, std::chrono::seconds timeout) const;
  /// The same of standard output.
  bool wait_for_out(const std::string& text, std::chrono::seconds timeout) const;
  /// Waits for the end; a program that takes longer is killed.
  CommandResult finish(std::chrono::seconds timeout);

 private:
  bool wait_for(const std::string& file, const std::string& text,
                std::chrono::seconds timeout) const;

  std::string folder_;
  pid_t pid_ = -1;
};

/// True when the process is gone, or gone before `timeout` is over.
bool ends_within(pid_t pid, std::chrono::seconds timeout);

/// Runs a program to its end.
CommandResult run_command(const std::vector<std::string>& arguments,
                          const Command::Options& options = {},
                          std::chrono::seconds timeout = std::chrono::seconds{60});

/// The `armature` of this build.
std::string armature();
/// A file of the source tree.
std::string source_file(const std::string& path);

}  // namespace armature::test
