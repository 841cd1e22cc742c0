// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "armature/bus/sample.hpp"
#include "armature/bus/transport.hpp"

namespace armature ARMATURE_EXPORT {

/// Where a topic's samples go inside this process.
class Subscriber {
 public:
  virtual ~Subscriber() = default;
  /// Called on the publisher's thread: enqueue and return. Real-time safe.
  virtual void deliver(const SampleRef& sample) = 0;
  /// How many samples it may hold at a time; so many more are kept ready.
  virtual std::size_t max_held() const { return 0; }
};

/// Whose samples a subscriber takes when they come from other processes: of the deployment's own
/// ones, or of any program that writes the topic.
enum class Sources { deployment, any };

/// One topic inside this process: by pointer to every subscriber, and to the outside writer when
/// there is one. Wired before the deployment starts and constant while it runs. One component
/// publishes on it; several that share a topic have one each, which pass on to the subscribers'
/// one.
class Topic {
 public:
  Topic(TopicSpec spec, std::size_t preallocated);

  const TopicSpec& spec() const { return spec_; }
  void connect(Subscriber& subscriber, Sources sources = Sources::deployment) {
    subscribers_.push_back({&subscriber, sources});
    pool_.reserve(subscriber.max_held());
  }
  void attach(std::unique_ptr<RemoteWriter> writer) { remote_ = std::move(writer); }
  const RemoteWriter* remote() const { return remote_.get(); }
  /// Samples also go to the subscribers of `hub`, which outlives this topic's publishing.
  void pass_on_to(Topic& hub) { hub_ = &hub; }
  /// True when a sample published now reaches somebody, here or outside. Real-time safe.
  bool has_readers() const;

  SampleRef loan() { return pool_.loan(); }
  /// Keeps `more` samples ready, for somebody who holds them. Before the run.
  void reserve(std::size_t more) { pool_.reserve(more); }
  /// Copies `message` into every sample that is kept ready, now or later.
  void prepare(const void* message) { pool_.prepare(message); }
  /// The number of the next sample; every sample takes one.
  std::uint64_t next_sequence() { return ++sequence_; }
  /// Gives the sample the next sequence number, and sends it.
  void publish(SampleRef sample, Time now);
  /// Stamps a sample that has its number with `now`, and hands it to everybody.
  void send(SampleRef sample, Time now);
  /// Hands a sample of another writer of this process to all subscribers (its info is kept).
  void deliver(const SampleRef& sample);
  /// Hands a sample of another process to the subscribers with these `sources`, for which it was
  /// read. Any thread.
  void deliver(const SampleRef& sample, Sources sources);

  std::uint64_t published() const { return sequence_; }
  std::size_t pool_growth() const { return pool_.grown(); }

 private:
  TopicSpec spec_;
  SamplePool pool_;
  struct Connection {
    Subscriber* subscriber;
    Sources sources;
  };
  std::vector<Connection> subscribers_;
  Topic* hub_ = nullptr;
  std::unique_ptr<RemoteWriter> remote_;
  std::uint64_t sequence_ = 0;
};

}  // namespace armature
