// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <atomic>
#include <chrono>
#include <cstdint>
#include <deque>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "armature/runtime/component/component.hpp"
#include "armature/runtime/component/driver_thread.hpp"
#include "armature/runtime/component/inbox.hpp"
#include "armature/runtime/component/output_port.hpp"
#include "armature/runtime/component/slot.hpp"
#include "armature/runtime/component/status_reporter.hpp"
#include "armature/runtime/execution/clock.hpp"
#include "armature/runtime/execution/timing_histogram.hpp"
#include "armature/runtime/plugins/plugin_library.hpp"

namespace armature ARMATURE_EXPORT {

class InjectedFault;

/// A component with what belongs to it: ports, period, counters, and the rule that its callbacks
/// never run two at a time (one scheduler owns it).
class ComponentRunner {
 public:
  ComponentRunner(std::string name, std::string plugin_id, int place, StatusReporter::Sink sink);

  const std::string& name() const { return name_; }
  const std::string& plugin_id() const { return plugin_id_; }
  /// Its place in the graph: sources first.
  int place() const { return place_; }
  Inbox& inbox() { return inbox_; }
  const Inbox& inbox() const { return inbox_; }
  std::deque<OutputPort>& outputs() { return outputs_; }
  /// Where its plugins sit. A successor that is offered to one sits there from the next step on.
  std::vector<std::unique_ptr<SlotPlace>>& slots() { return slots_; }
  const std::shared_ptr<StatusReporter>& reporter() { return reporter_; }
  StatusReporter::Status status() const { return reporter_->status(); }
  const std::optional<Duration>& period() const { return period_; }
  void set_period(Duration period) { period_ = period; }
  /// On the simulated clock, how much later its samples reach their readers.
  Duration latency() const { return latency_; }
  void set_latency(Duration latency) { latency_ = latency; }
  /// `library` holds the code of the component and of its slots; null: this program does.
  void install(std::shared_ptr<PluginLibrary> library, std::unique_ptr<Component> component) {
    library_ = std::move(library);
    component_ = std::move(component);
    for (OutputPort& output : outputs_) output.open();
  }
  Component& component() { return *component_; }

  /// A thread of the component's own, before the run.
  void add_thread(std::unique_ptr<DriverThread> thread) { threads_.push_back(std::move(thread)); }
  /// Starts them; `clock` outlives the component. Where they were started already nothing happens.
  void start_threads(const Clock& clock);
  void request_threads_stop();
  /// False when one has not returned until `end`.
  bool join_threads(std::chrono::steady_clock::time_point end);

  /// A drill's fault, which outlives the component.
  void inject(const InjectedFault& fault) { injected_ = &fault; }

  /// Set once it has finished or failed; any thread reads it, and it outlives the run.
  void tell_end(std::atomic<bool>& ended) { ended_ = &ended; }
  /// Called when a trigger input gets a sample; any thread.
  void on_triggered(std::function<void()> callback) { triggered_ = std::move(callback); }

  /// One activation, unless the component has finished; `lateness` is how long after its release.
  /// An exception is caught and becomes the component's fault: the component is not called again
  /// and its outputs end.
  void activate(Time now, Duration lateness = {});
  /// The same, also of a component that has finished.
  void step(Time now, Duration lateness = {});
  /// Asks the component to come to rest, at its next activation or `answer_stop_request`. Any
  /// thread; real-time safe.
  void request_stop() { stop_requested_.store(true, std::memory_order_release); }
  /// Hands a stop request to the component, once, without a step. On its executor's thread.
  void answer_stop_request(Time now);
  void count_overruns(std::uint64_t periods) { overruns_ += periods; }
  void stop(Time now);
  /// Asks the component for its figures, once it has stopped; an exception is its fault.
  void summarize(Summary& summary);
  /// What the component can say before it runs. Throws what it throws.
  std::vector<std::string> notes_for_check() const;

  bool faulted() const { return faulted_.load(std::memory_order_acquire); }
  /// True when the component was asked to come to rest and is there. One that has failed is not
  /// asked any more and counts as stopped. Any thread.
  bool stopped() const { return faulted() || stopped_.load(std::memory_order_acquire); }
  bool finished() const { return finished_.load(std::memory_order_acquire); }
  std::uint64_t activations() const { return activations_.load(std::memory_order_relaxed); }
  std::uint64_t overruns() const { return overruns_.load(std::memory_order_relaxed); }
  /// What full queues have lost, of inputs, driver threads and the way to other processes, and what
  /// did not arrive from these.
  std::uint64_t dropped() const;

  /// Of its steps since the start. Any thread.
  const StepTimes& times() const { return times_; }
  /// From how many components measurements come (SampleInfo::answers_to). Before the run.
  void expect_measurements(std::size_t sources) {
    reactions_ = std::vector<TimingHistogram>(sources);
  }
  /// How old the measurements of each of them were when a step had answered to them. Any thread.
  const std::vector<TimingHistogram>& reactions() const { return reactions_; }
  /// Told by the executor that runs it, which outlives it; in lockstep there is none.
  void set_executor(const std::string& name, const CycleTimes& times) {
    executor_name_ = &name;
    executor_times_ = &times;
  }
  const std::string* executor_name() const { return executor_name_; }
  const CycleTimes* executor_times() const { return executor_times_; }

  /// When the component's code that runs now was entered, on the monotonic clock [ns]; 0 when none
  /// runs. Any thread.
  std::int64_t running_since_ns() const {
    return running_since_ns_.load(std::memory_order_relaxed);
  }
  /// The watchdog's word that what runs does not return: for how long; 0: all is well. Any thread.
  void set_stalled(Duration since) { stalled_ns_.store(since.count(), std::memory_order_relaxed); }
  Duration stalled() const { return Duration{stalled_ns_.load(std::memory_order_relaxed)}; }

 private:
  class Running;
  class Tapped;
  void ask_stopped();
  /// Counts a step that was activated at `now` and took `duration`.
  void count_reaction(Time now, Duration duration);
  void fault(std::string_view when, const std::string& what);

  std::string name_, plugin_id_;
  int place_;
  std::function<void()> triggered_;
  std::atomic<bool>* ended_ = nullptr;
  Inbox inbox_;
  std::deque<OutputPort> outputs_;
  std::shared_ptr<StatusReporter> reporter_;
  std::optional<Duration> period_;
  Duration latency_{0};
  const InjectedFault* injected_ = nullptr;
  // In this order: threads go first, then the component, its slots, the code of all, and its ports.
  std::shared_ptr<PluginLibrary> library_;
  std::vector<std::unique_ptr<SlotPlace>> slots_;
  std::unique_ptr<Component> component_;
  std::vector<std::unique_ptr<DriverThread>> threads_;
  std::atomic<bool> faulted_{false}, finished_{false};
  std::atomic<bool> stop_requested_{false}, stopped_{false};
  bool stop_begun_ = false;  // of the executor's thread
  bool told_floats_ = false;
  bool threads_started_ = false;
  std::atomic<std::uint64_t> activations_{0}, overruns_{0};
  StepTimes times_;
  std::vector<TimingHistogram> reactions_;
  const std::string* executor_name_ = nullptr;
  const CycleTimes* executor_times_ = nullptr;
  std::atomic<std::int64_t> running_since_ns_{0}, stalled_ns_{0};
};

}  // namespace armature
