// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "armature/bus/network.hpp"
#include "armature/bus/qos.hpp"
#include "armature/bus/sample.hpp"
#include "armature/messages/message_type.hpp"
#include "armature/values/expected.hpp"

namespace armature ARMATURE_EXPORT {

/// One topic as the outside sees it.
struct TopicSpec {
  std::string name;  // DDS name: "rt/dental_lamp/arm/measured_js"
  const MessageType* type = nullptr;
  QosProfile qos = QosProfile::state;
};

/// A reader in another process, for people.
struct Watcher {
  std::string owner;           // "deployment 'lamp', process 'main' (pid 123 on theatre-2)"
  bool of_deployment = false;  // of one of ours, whichever; not a recorder or another program
};

/// Our end of a topic that others may read.
class RemoteWriter {
 public:
  virtual ~RemoteWriter() = default;
  /// Hands a sample to the egress thread if anybody outside has matched; never blocks, never
  /// encodes, drops the oldest waiting sample when the queue is full (and counts it).
  virtual void offer(const SampleRef& sample) = 0;
  virtual int matched_readers() const = 0;
  /// Counts the readers of the deployment's other processes that it has met and that are still
  /// there.
  virtual int peers() const = 0;
  virtual std::uint64_t dropped() const = 0;
  /// Who has matched so far. Any thread.
  virtual std::vector<Watcher> who_watches() const = 0;
  /// Waits until every reliable reader has acknowledged what was offered; false when one has not
  /// within `timeout`.
  virtual bool acknowledged(Duration timeout) = 0;
};

/// Samples of one writer that is no part of the deployment.
struct RefusedSamples {
  std::string writer;  // "participant 'talker' (pid 123 on theatre-2)"
  std::uint64_t count = 0;
};

/// Our end of a topic that another process feeds; destroying it stops the deliveries.
class RemoteReader {
 public:
  virtual ~RemoteReader() = default;
  virtual int writers() const = 0;
  /// Counts the writers of the deployment's other processes that it has met and that are still
  /// there.
  virtual int peers() const = 0;
  /// What was refused so far, by writer. Any thread.
  virtual std::vector<RefusedSamples> refused() const = 0;
};

/// What may happen on the network that an operator must know: a second type on a topic, another
/// layout under the same name, QoS that cannot match, a writer of another deployment that was
/// refused, a process that died, a note of the transport itself (no shared memory, its own errors).
struct TransportEvent {
  enum class Kind { type_conflict, layout_conflict, qos_conflict, foreign_writer, peer_lost, note };
  Kind kind;
  std::string topic;
  std::string text;
  bool of_peer = false;  // it is about one of the deployment's other processes
};

struct TransportOptions {
  NetworkOptions network = {};
  std::string deployment;    // its name, and
  std::string fingerprint;   // the hash of its resolved configuration
  std::string run = {};      // what its processes share that were started together; nothing by hand
  std::string process = {};  // which of its processes this is
  std::function<void(const TransportEvent&)> on_event;  // any thread; must only enqueue
  /// The deployment's clock, the same in all of its processes. None: the system clock.
  std::function<Time()> now;
  bool simulated = false;  // that clock has nothing to do with anybody else's
};

/// The way to other processes. Plugins of kind `transport`; the runtime loads `transport/fast_dds`.
class Transport {
 public:
  static constexpr std::string_view kKind = "transport";
  /// Refuses with a reason that names the way out.
  using Factory = Expected<std::unique_ptr<Transport>> (*)(const TransportOptions&);

  virtual ~Transport() = default;
  /// After the readers of the same topic in this process: who else writes what nobody here reads is
  /// reported.
  virtual Expected<std::unique_ptr<RemoteWriter>> advertise(const TopicSpec& topic) = 0;
  /// `deliver` is called on a transport thread and must only enqueue. Samples of this process'
  /// own writers are never delivered. `same_deployment_only`: writers with another fingerprint or
  /// run are refused, reported once by name, and counted.
  virtual Expected<std::unique_ptr<RemoteReader>> subscribe(
      const TopicSpec& topic, bool same_deployment_only,
      std::function<void(SampleRef)> deliver) = 0;
};

}  // namespace armature
