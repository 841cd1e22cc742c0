// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <atomic>
#include <cstdint>
#include <thread>
#include <utility>

#include "armature/bus/topic.hpp"
#include "armature/runtime/component/inbox.hpp"
#include "armature/runtime/plugins/plugin_manifest.hpp"
#include "armature/values/time.hpp"

namespace armature ARMATURE_EXPORT {

/// When a published sample reaches its readers: at once, or later on the simulated clock.
class Delivery {
 public:
  virtual ~Delivery() = default;
  /// `sample` has its sequence number.
  virtual void publish(Topic& topic, SampleRef sample) = 0;
};

/// One output of a component. What it publishes answers to what `inbox` shows.
class OutputPort {
 public:
  /// `writer` is its number in this process (SampleInfo).
  OutputPort(PortSpec spec, Topic& topic, Delivery& delivery, const Inbox& inbox,
             std::uint32_t writer = 0)
      : spec_{std::move(spec)},
        topic_{&topic},
        delivery_{&delivery},
        inbox_{&inbox},
        writer_{writer} {}

  const PortSpec& spec() const { return spec_; }
  std::uint32_t writer() const { return writer_; }
  Topic& topic() { return *topic_; }
  const Topic& topic() const { return *topic_; }
  bool has_subscribers() const {
    const bool truly = !closed() && (settings(spec_.qos).transient_local || topic_->has_readers());
    return inbox_->tap() ? inbox_->tap()->has_subscribers(truly) : truly;
  }
  void publish(SampleRef sample) {
    const State state = state_.load(std::memory_order_acquire);
    if (state == State::closed) return;
    if (state == State::not_open) return refuse_or_drop();
    SampleInfo& info = sample.mutable_info();
    info.writer = writer_;
    info.sequence = topic_->next_sequence();
    info.answers_to = inbox_->answers_to();
    if (inbox_->tap()) inbox_->tap()->published(sample);
    delivery_->publish(*topic_, std::move(sample));
  }
  /// The component is constructed. Before, its readers are not: what it published would be lost.
  void open() { state_.store(State::open, std::memory_order_release); }
  /// Nothing is published from now on, whichever thread of the component tries. Any thread.
  void close() { state_.store(State::closed, std::memory_order_release); }

 private:
  enum class State : std::uint8_t { not_open, open, closed };
  bool closed() const { return state_.load(std::memory_order_acquire) == State::closed; }
  /// Throws SetupError on the thread that constructs the component; a thread of its own, which
  /// nobody could catch it on, loses the sample.
  void refuse_or_drop() const;

  PortSpec spec_;
  Topic* topic_;
  Delivery* delivery_;
  const Inbox* inbox_;
  std::uint32_t writer_;
  std::thread::id constructs_ = std::this_thread::get_id();
  std::atomic<State> state_{State::not_open};
};

}  // namespace armature
