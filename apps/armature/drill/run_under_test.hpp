// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <sys/types.h>

#include <chrono>
#include <functional>
#include <map>
#include <mutex>
#include <optional>
#include <stop_token>
#include <string>
#include <thread>
#include <vector>

namespace armature::drill {

/// `armature run` (or another verb) as a process of its own, with all that it prints for the
/// operator. It is killed, with the processes that it has started, when this goes.
class RunUnderTest {
 public:
  /// `arguments`: those behind `armature`. It is interrupted once, from any thread, when `stop` is
  /// requested. Throws std::system_error when it cannot be started.
  RunUnderTest(std::vector<std::string> arguments, const std::stop_token& stop);
  ~RunUnderTest();
  RunUnderTest(const RunUnderTest&) = delete;
  RunUnderTest& operator=(const RunUnderTest&) = delete;

  /// Finds the processes that it has started by now, by the name that the deployment gives them.
  void find_processes();
  /// Sends a signal to a process of the deployment; false when there is none of that name. "main"
  /// is always there.
  bool signal(const std::string& process, int number);
  void signal(int number) { signal("main", number); }

  /// False when its main process has ended.
  bool runs();
  /// Waits for the end of all of its processes; false when they take longer.
  bool ends_within(std::chrono::milliseconds timeout);
  /// The exit code of the main process, or 128 and its signal; nothing while it runs.
  std::optional<int> exit_code() const { return exit_code_; }

  /// The first line with this text, waited for. Without one nothing.
  std::optional<std::string> wait_for_line(const std::string& text,
                                           std::chrono::milliseconds timeout);
  std::optional<std::string> line_with(const std::string& text) const;
  /// Counts the lines with `text` that `component` has said.
  std::ptrdiff_t count_lines(const std::string& component, const std::string& text) const;
  /// What it has written on standard output.
  std::string output() const;
  /// The last thing it said.
  std::string last_line() const;

  /// Nobody reads standard error any more: the terminal is closed.
  void close_terminal();
  /// Nobody takes what it writes, and there is no room for more: a terminal that stands still.
  void fill_terminal();

 private:
  enum class Reading { on, paused, closed };
  void read_lines(std::stop_token stop);
  void take(std::string_view text);
  bool all_ended();
  void interrupt();

  pid_t pid_ = -1;
  std::map<std::string, pid_t> processes_;
  std::mutex process_mutex_;  // so that no process is interrupted that has been waited for
  std::optional<int> exit_code_;
  int output_ = -1;    // a file in memory: its standard output
  int terminal_ = -1;  // our end of its standard error
  mutable std::mutex mutex_;
  Reading reading_ = Reading::on;
  bool read_to_end_ = false;
  std::string unfinished_;
  std::vector<std::string> lines_;
  std::jthread reader_;
  std::optional<std::stop_callback<std::function<void()>>> on_stop_;
};

}  // namespace armature::drill
