// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <atomic>
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
  virtual void publish(Topic& topic, SampleRef sample) = 0;
};

/// One output of a component. What it publishes answers to what `inbox` shows.
class OutputPort {
 public:
  OutputPort(PortSpec spec, Topic& topic, Delivery& delivery, const Inbox& inbox)
      : spec_{std::move(spec)}, topic_{&topic}, delivery_{&delivery}, inbox_{&inbox} {}

  const PortSpec& spec() const { return spec_; }
  Topic& topic() { return *topic_; }
  bool has_subscribers() const {
    return !closed() && (settings(spec_.qos).transient_local || topic_->has_readers());
  }
  void publish(SampleRef sample) {
    if (closed()) return;
    sample.mutable_info().answers_to = inbox_->answers_to();
    delivery_->publish(*topic_, std::move(sample));
  }
  /// Nothing is published from now on, whichever thread of the component tries. Any thread.
  void close() { closed_.store(true, std::memory_order_release); }

 private:
  bool closed() const { return closed_.load(std::memory_order_acquire); }

  PortSpec spec_;
  Topic* topic_;
  Delivery* delivery_;
  const Inbox* inbox_;
  std::atomic<bool> closed_{false};
};

}  // namespace armature
