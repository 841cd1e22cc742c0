// SPDX-License-Identifier: Apache-2.0
#include "armature/runtime/processes/end_watch.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <condition_variable>
#include <mutex>
#include <system_error>
#include <thread>
#include <utility>

namespace armature {

struct EndWatch::State {
  State(Duration timeout, std::function<void(const std::string&)> on_hung)
      : timeout_{timeout}, on_hung_{std::move(on_hung)} {}

  /// Of the watching thread. Returns when there is nothing to watch any more.
  void watch() {
    constexpr std::chrono::milliseconds kTick{20};
    std::unique_lock lock{mutex_};
    auto before = std::chrono::steady_clock::now();
    while (!changed_.wait_for(lock, kTick, [this] { return over_; })) {
      const auto now = std::chrono::steady_clock::now();
      observed_ += std::min<Duration>(now - before, 2 * kTick);
      before = now;
      if (observed_ < timeout_) continue;
      const std::string text =
          fmt::format("{} has not returned for {:g} s", what_, to_seconds(timeout_));
      telling_ = true;
      lock.unlock();
      on_hung_(text);
      lock.lock();
      telling_ = false;
      changed_.notify_all();
      return;
    }
  }

  const Duration timeout_;
  const std::function<void(const std::string&)> on_hung_;
  std::mutex mutex_;
  std::condition_variable changed_;
  std::string what_;  // guarded, as all below
  Duration observed_{0};
  bool telling_ = false, over_ = false;
  std::thread thread_;
};

EndWatch::EndWatch(Duration timeout, std::function<void(const std::string&)> on_hung)
    : state_{std::make_unique<State>(timeout, std::move(on_hung))} {}

EndWatch::~EndWatch() {
  {
    const std::scoped_lock lock{state_->mutex_};
    state_->over_ = true;
  }
  state_->changed_.notify_all();
  if (state_->thread_.joinable()) state_->thread_.join();
}

void EndWatch::begin(const std::string& what) {
  std::unique_lock lock{state_->mutex_};
  state_->changed_.wait(lock, [this] { return !state_->telling_; });
  state_->what_ = what;
  state_->observed_ = Duration{0};
  if (state_->thread_.joinable()) return;
  try {
    state_->thread_ = std::thread{[this] { state_->watch(); }};
  } catch (const std::system_error&) {
    // No thread is to be had; the end itself goes on.
  }
}

}  // namespace armature
