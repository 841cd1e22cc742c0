// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <string>

namespace armature {

/// How far a long calculation is, on standard error, twice a second; silent when that is not a
/// terminal. The line is gone when the calculation ends.
class Progress {
 public:
  explicit Progress(std::string what);
  ~Progress();
  Progress(const Progress&) = delete;
  Progress& operator=(const Progress&) = delete;

  void part(double part);  // of all, 0 to 1
  /// Tells how many are done of all, and what time is left if it goes on like this.
  void of(std::size_t done, std::size_t all);
  void count(std::uint64_t so_far);  // of an unknown number

 private:
  using Clock = std::chrono::steady_clock;
  bool due();
  void show(const std::string& line);

  std::string what_;
  bool terminal_;
  bool shown_ = false;
  Clock::time_point start_, next_;
};

}  // namespace armature
