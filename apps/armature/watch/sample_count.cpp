// SPDX-License-Identifier: Apache-2.0
#include "watch/sample_count.hpp"

#include <fmt/format.h>

#include <chrono>
#include <string>
#include <thread>

#include "exit_code.hpp"

namespace armature {

int SampleCount::wait(const std::function<void()>& every_second) {
  const auto start = std::chrono::steady_clock::now();
  auto tick = start;
  while (!left() && !full()) {
    if (std::chrono::steady_clock::now() - tick >= std::chrono::seconds{1}) {
      tick += std::chrono::seconds{1};
      every_second();
    }
    const std::chrono::duration<double> elapsed = std::chrono::steady_clock::now() - start;
    if (options_.timeout_s > 0 && elapsed.count() > options_.timeout_s) {
      return options_.count > 0 || seen_ < least_ ? timed_out() : kOk;
    }
    std::this_thread::sleep_for(std::chrono::milliseconds{20});
  }
  return kOk;
}

int SampleCount::timed_out() const {
  const std::uint64_t wanted = options_.count > 0 ? options_.count : least_;
  const std::string came =
      seen_ == 0 ? "no sample" : fmt::format("{} of {} samples", seen_.load(), wanted);
  fmt::print(stderr, "armature: {} of '{}' came within {:g} s\n", came, options_.topic,
             options_.timeout_s);
  return kTimedOut;
}

}  // namespace armature
