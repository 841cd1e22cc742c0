// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <fmt/format.h>

#include <chrono>
#include <condition_variable>
#include <functional>
#include <mutex>
#include <stop_token>
#include <string>
#include <thread>
#include <utility>

namespace armature {

/// Tells of a component, while it is being made, that this takes long: a driver that waits for its
/// device, and a whole deployment with it. Once, from a thread of its own.
class SlowConstructor {
 public:
  SlowConstructor(std::string component, std::function<void(const std::string&)> tell)
      : watch_{[component = std::move(component), tell = std::move(tell)](std::stop_token made) {
          std::mutex mutex;
          std::unique_lock lock{mutex};
          std::condition_variable_any().wait_for(lock, made, kLong, [] { return false; });
          if (made.stop_requested() || !tell) return;
          tell(
              fmt::format("component '{}' has been in its constructor for {} s, and nothing "
                          "begins before it returns",
                          component, kLong.count()));
        }} {}

 private:
  static constexpr std::chrono::seconds kLong{5};
  std::jthread watch_;
};

}  // namespace armature
