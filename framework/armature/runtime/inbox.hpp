// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <deque>
#include <functional>
#include <memory>
#include <mutex>
#include <vector>

#include "armature/bus/topic.hpp"
#include "armature/runtime/plugin_manifest.hpp"

namespace armature {

class Inbox;

/// One input of a component: what has arrived, and what the running activation is shown.
class InputPort final : public Subscriber {
 public:
  InputPort(PortSpec spec, const MessageType& type, Inbox& inbox);

  void deliver(const SampleRef& sample) override;

  const PortSpec& spec() const { return spec_; }
  const MessageType& type() const { return *type_; }
  const std::vector<SampleRef>& shown() const { return shown_; }
  bool fresh() const { return fresh_; }

 private:
  friend class Inbox;
  void keep(const SampleRef& sample);
  void show(Time now);
  Time stamp_of(const SampleRef& sample) const;

  PortSpec spec_;
  const MessageType* type_;
  Inbox* inbox_;
  std::vector<SampleRef> waiting_;  // a ring of at most capacity_, oldest at first_
  std::size_t capacity_;
  std::deque<SampleRef> unmatched_;  // of a joined input: waits for its partners
  std::vector<SampleRef> shown_;
  bool fresh_ = false;
};

/// All inputs of one component behind one lock: samples arrive from any thread, and are shown to an
/// activation all at once.
class Inbox {
 public:
  /// `on_trigger` is called on the publisher's thread when the component should be activated.
  explicit Inbox(std::function<void()> on_trigger) : on_trigger_{std::move(on_trigger)} {}

  InputPort& add(PortSpec spec, const MessageType& type);
  const std::vector<std::unique_ptr<InputPort>>& ports() const { return ports_; }

  /// Freezes what the next activation sees.
  void show(Time now);
  /// Samples that full queues have lost.
  std::uint64_t dropped() const;

 private:
  friend class InputPort;
  void arrived(InputPort& port, const SampleRef& sample);
  bool match_joined();

  std::function<void()> on_trigger_;
  mutable std::mutex mutex_;
  std::vector<std::unique_ptr<InputPort>> ports_;
  std::uint64_t dropped_ = 0;
};

}  // namespace armature
