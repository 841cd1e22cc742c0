// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <atomic>
#include <cstdint>
#include <functional>
#include <memory>
#include <vector>

#include "armature/bus/topic.hpp"
#include "armature/runtime/component/activation_tap.hpp"
#include "armature/runtime/plugins/plugin_manifest.hpp"
#include "armature/values/real_time_mutex.hpp"

namespace armature ARMATURE_EXPORT {

class Inbox;

/// One input of a component: what has arrived, and what the running activation is shown.
class InputPort final : public Subscriber {
 public:
  InputPort(PortSpec spec, const MessageType& type, Inbox& inbox);

  void deliver(const SampleRef& sample) override;
  /// What waits and what the running activation is shown.
  std::size_t max_held() const override { return 2 * capacity_ + (spec_.join ? kJoinDepth : 0); }

  const PortSpec& spec() const { return spec_; }
  const MessageType& type() const { return *type_; }
  const std::vector<SampleRef>& shown() const { return shown_; }
  bool fresh() const { return fresh_; }
  /// Before the first sample arrives: whose measurements these are (SampleInfo::answers_to), and
  /// whether the component answers to them. Otherwise: to what its samples answer to, unless the
  /// input is feedback.
  void set_source(int source, bool is_answered) {
    source_ = source;
    is_answered_ = is_answered;
  }
  /// Before the first sample arrives; see Setup::input_if.
  void heed_only(bool (*heeds)(const void* message)) { heeds_ = heeds; }

 private:
  friend class Inbox;
  // Joined inputs wait for their partners this many samples long.
  static constexpr std::size_t kJoinDepth = 4;
  void keep(const SampleRef& sample);
  void show(Time now);
  Time stamp_of(const SampleRef& sample) const;
  /// What a sample's age goes by. Programs that are not part of the deployment have their own
  /// clock.
  Time judged_time(const SampleRef& sample) const {
    return spec_.outside ? sample.info().published : stamp_of(sample);
  }
  bool is_too_far_ahead(const SampleRef& sample, Time now);
  Measurement oldest_measurement() const;

  PortSpec spec_;
  const MessageType* type_;
  Inbox* inbox_;
  bool (*heeds_)(const void* message) = nullptr;  // none: every sample
  int source_ = -1;
  bool is_answered_;
  // Oldest first, with memory for as many as there ever are.
  std::vector<SampleRef> waiting_;
  std::size_t capacity_;
  std::vector<SampleRef> unmatched_;  // of a joined input: waits for its partners
  std::vector<SampleRef> shown_;
  bool fresh_ = false;
};

/// All inputs of one component behind one lock: samples arrive from any thread, and are shown to an
/// activation all at once. Once its ports are there, nothing allocates.
class Inbox {
 public:
  /// `on_trigger` is called on the publisher's thread when the component should be activated.
  explicit Inbox(std::function<void()> on_trigger) : on_trigger_{std::move(on_trigger)} {}

  InputPort& add(PortSpec spec, const MessageType& type);
  const std::vector<std::unique_ptr<InputPort>>& ports() const { return ports_; }

  /// Freezes what the next activation sees.
  void show(Time now);
  /// Who is told what the component reads and writes, and outlives it. Before the run.
  void set_tap(ActivationTap* tap) { tap_ = tap; }
  ActivationTap* tap() const { return tap_; }
  /// For a replay: what the next activation is newly shown on `port`, after what was put before.
  void put(InputPort& port, const SampleRef& sample);
  /// There is no further activation: what arrives is not kept, nor counted as lost. Any thread.
  void close();
  /// The oldest measurement among what the running activation was newly shown. Any thread.
  Measurement answers_to() const {
    return {.source = source_.load(std::memory_order_relaxed),
            .at = Time{measured_at_ns_.load(std::memory_order_relaxed)}};
  }
  /// Samples that full queues have lost, and those that did not arrive from another process.
  std::uint64_t dropped() const;
  /// Samples that were not shown because they are stamped too far ahead of now: how many, which
  /// input the last one was for, and how far. Any thread.
  struct Ahead {
    std::uint64_t samples = 0;
    const InputPort* port = nullptr;
    Duration by{0};
  };
  Ahead ahead() const;

 private:
  friend class InputPort;
  void arrived(InputPort& port, const SampleRef& sample);
  void count_lost(std::uint64_t samples);
  bool match_joined();

  std::function<void()> on_trigger_;
  ActivationTap* tap_ = nullptr;
  mutable RealTimeMutex mutex_;
  std::vector<std::unique_ptr<InputPort>> ports_;
  std::vector<InputPort*> joined_;  // those of them that are shown only together
  bool closed_ = false;
  std::uint64_t dropped_ = 0;
  Ahead ahead_;
  std::atomic<int> source_{-1};
  std::atomic<std::int64_t> measured_at_ns_{0};
};

}  // namespace armature
