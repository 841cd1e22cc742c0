// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <sys/types.h>

#include <chrono>
#include <cstddef>
#include <functional>
#include <string>

namespace armature {

/// What became of work in a child process.
struct Isolated {
  std::string result;  // what the work returned
  std::string fault;   // why it returned nothing: "killed by signal 11 (Segmentation fault)"
  bool timed_out = false;
};

/// Work in a child process, which may crash or hang without taking this one with it. What it prints
/// on standard output is lost. To be started by a process with one thread.
class IsolatedWork {
 public:
  /// Throws std::runtime_error when there can be no process.
  IsolatedWork(double timeout_s, const std::function<std::string()>& work);
  /// Kills it, if it is still there.
  ~IsolatedWork();
  IsolatedWork(const IsolatedWork&) = delete;
  IsolatedWork& operator=(const IsolatedWork&) = delete;

  /// Can be read when there is something to take: for poll(2).
  int descriptor() const { return from_; }
  /// Takes what there is, and waits for no more; true when the work is done or its time is over.
  bool is_over();
  /// Once it is over.
  Isolated outcome();

 private:
  using Clock = std::chrono::steady_clock;
  double timeout_s_;
  Clock::time_point end_;
  pid_t child_ = -1;
  int from_ = -1;
  bool told_all_ = false;
  std::string result_;
};

/// Does `work` in a child process and waits for it; it is killed after `timeout_s`.
Isolated isolated(double timeout_s, const std::function<std::string()>& work);

/// Does `work(0)` to `work(count - 1)`, each in a child process that is killed after `timeout_s`,
/// `at_once` at a time; `take` has each outcome as soon as it is there, in any order.
void isolated_each(std::size_t count, std::size_t at_once, double timeout_s,
                   const std::function<std::string(std::size_t)>& work,
                   const std::function<void(std::size_t, const Isolated&)>& take);

/// The number of processors of this machine, at least 1.
std::size_t processors();

}  // namespace armature
