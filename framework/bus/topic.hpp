// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "armature/bus/sample.hpp"
#include "armature/bus/transport.hpp"

namespace armature {

/// Where a topic's samples go inside this process.
class Subscriber {
 public:
  virtual ~Subscriber() = default;
  /// Called on the publisher's thread: enqueue and return. Real-time safe.
  virtual void deliver(const SampleRef& sample) = 0;
};

/// One topic inside this process: by pointer to every subscriber, and to the outside writer when
/// there is one. Wired before the deployment starts and constant while it runs.
class Topic {
 public:
  Topic(TopicSpec spec, std::size_t preallocated);

  const TopicSpec& spec() const { return spec_; }
  void connect(Subscriber& subscriber) { subscribers_.push_back(&subscriber); }
  void attach(std::unique_ptr<OutsideWriter> writer) { outside_ = std::move(writer); }
  const OutsideWriter* outside() const { return outside_.get(); }

  SampleRef loan() { return pool_.loan(); }
  /// Stamps the sample with `now` and the next sequence number and hands it to everybody.
  void publish(SampleRef sample, Time now);
  /// Hands over a sample that came from outside (its info is kept).
  void deliver_from_outside(const SampleRef& sample);

  std::uint64_t published() const { return sequence_; }
  std::size_t pool_growth() const { return pool_.grown(); }

 private:
  TopicSpec spec_;
  SamplePool pool_;
  std::vector<Subscriber*> subscribers_;
  std::unique_ptr<OutsideWriter> outside_;
  std::uint64_t sequence_ = 0;
};

}  // namespace armature
