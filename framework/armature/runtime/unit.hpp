// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <atomic>
#include <cstdint>
#include <deque>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <string_view>

#include "armature/runtime/component.hpp"
#include "armature/runtime/inbox.hpp"
#include "armature/runtime/output_port.hpp"
#include "armature/runtime/plugin_library.hpp"
#include "armature/runtime/voice.hpp"

namespace armature {

/// A component with what belongs to it: ports, period, counters, and the rule that its callbacks
/// never run two at a time (one scheduler owns it).
class Unit {
 public:
  Unit(std::string name, std::string plugin_id, int place, Voice::Sink sink);

  const std::string& name() const { return name_; }
  const std::string& plugin_id() const { return plugin_id_; }
  /// Its place in the graph: sources first.
  int place() const { return place_; }
  Inbox& inbox() { return inbox_; }
  const Inbox& inbox() const { return inbox_; }
  std::deque<OutputPort>& outputs() { return outputs_; }
  const std::shared_ptr<Voice>& voice() { return voice_; }
  Voice::Status status() const { return voice_->status(); }
  const std::optional<Duration>& period() const { return period_; }
  void set_period(Duration period) { period_ = period; }
  void install(PluginPtr<Component> component) { component_ = std::move(component); }
  Component& component() { return *component_; }

  /// Called when a trigger input gets a sample; any thread.
  void on_triggered(std::function<void()> callback) { triggered_ = std::move(callback); }

  /// One activation. An exception is caught, becomes the unit's fault, and the unit is not called
  /// again.
  void activate(Time now);
  void count_overruns(std::uint64_t periods) { overruns_ += periods; }
  void stop(Time now);
  /// Asks the component for its figures, once it has stopped; an exception is its fault.
  void summarize(Summary& summary);

  bool faulted() const { return faulted_.load(std::memory_order_acquire); }
  bool finished() const { return finished_.load(std::memory_order_acquire); }
  std::uint64_t activations() const { return activations_.load(std::memory_order_relaxed); }
  std::uint64_t overruns() const { return overruns_.load(std::memory_order_relaxed); }

 private:
  void fault(std::string_view when, const std::string& what);

  std::string name_, plugin_id_;
  int place_;
  std::function<void()> triggered_;
  Inbox inbox_;
  std::deque<OutputPort> outputs_;
  std::shared_ptr<Voice> voice_;
  std::optional<Duration> period_;
  PluginPtr<Component> component_;  // last: it goes first, its ports after it
  std::atomic<bool> faulted_{false}, finished_{false};
  std::atomic<std::uint64_t> activations_{0}, overruns_{0};
};

}  // namespace armature
