// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "armature/bus/network.hpp"
#include "armature/values/expected.hpp"
#include "armature/values/time.hpp"

namespace armature ARMATURE_EXPORT {

/// A writer or reader as discovery shows it.
struct ObservedEndpoint {
  bool writes = false;
  std::string owner;  // "deployment 'dental_lamp', process 'vision' (pid 123 on theatre-2)"
  std::string type;   // DDS name
  bool reliable = false;
  bool transient_local = false;
  std::string deployment = {};  // the one of ours that it says it is of; empty: another program's
  std::uint64_t layout = 0;     // of its type, as MessageType::layout has it; 0: it does not say
  std::array<std::uint8_t, 16> guid = {};  // no two have the same
  /// Of a writer: whether the reader of its topic, where that is watched, hears it, or would.
  bool is_heard = true;
};

/// A topic as discovery shows it.
struct ObservedTopic {
  std::string name;                // DDS name: "rt/dental_lamp/arm/measured_js"
  std::vector<std::string> types;  // DDS names, first the one that is read; more are a conflict
  std::vector<std::string> deployments;  // those of ours that have endpoints there
  int writers = 0;
  int readers = 0;
  std::vector<ObservedEndpoint> endpoints;  // writers first, before all the one that is read
};

struct ObservedSample {
  std::span<const std::byte> cdr;  // with encapsulation header; valid during the call
  Time source;                     // time stamp of the writer
  const std::string& type;         // DDS name
  /// Samples that the same writer sent since the one before, and that did not arrive.
  std::uint64_t lost_before = 0;
  const ObservedEndpoint* writer = nullptr;  // null: discovery does not know it (yet)
};

struct ObserverOptions {
  NetworkOptions network = {};
  /// Whether a reliable writer is asked again for a sample that was lost. Until it comes, all that
  /// follow it are held back; when the writer is gone by then, they never come.
  bool asks_again = true;
};

/// An onlooker for the tools: sees every topic of a DDS domain and can read any of them without
/// generated code.
class DdsObserver {
 public:
  static constexpr std::string_view kKind = "observer";
  using Factory = Expected<std::unique_ptr<DdsObserver>> (*)(const ObserverOptions&);

  static Expected<std::unique_ptr<DdsObserver>> make(const ObserverOptions& options);
  virtual ~DdsObserver() = default;

  /// What has been discovered so far, sorted by name; complete about a second after make(). A topic
  /// whose name begins with '/' in DDS is none: that is how ROS 2 calls another one.
  virtual std::vector<ObservedTopic> topics() const = 0;

  /// Waits until `topic` has a writer (at most `timeout`), then calls `on_sample` on a DDS thread,
  /// one sample at a time, until the observer is destroyed. Takes a name as DDS has it, else one as
  /// ROS 2 has it: "chatter" is that topic of DDS where somebody writes it, else "rt/chatter", as
  /// "/chatter" is. The reader is made for the writer of the deployment that has the topic, when
  /// that has been found, else for one of another deployment of ours, else for any.
  virtual Expected<void> watch(const std::string& topic, Duration timeout,
                               std::function<void(const ObservedSample&)> on_sample) = 0;
  /// Takes the name that was watched. No sample of it is handed on when this has returned. Not from
  /// `on_sample`.
  virtual void unwatch(const std::string& topic) = 0;
  /// Makes the reader of each watched topic anew, as `watch` would make it now, that hears none of
  /// the writers that it would be made for: they came back with another type or less QoS, or the
  /// deployment that has the topic came after another program. Tells the DDS names of these topics.
  /// Not from `on_sample`.
  virtual std::vector<std::string> watch_again() = 0;
};

}  // namespace armature
