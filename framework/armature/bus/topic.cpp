// SPDX-License-Identifier: Apache-2.0
#include "armature/bus/topic.hpp"

#include <utility>

namespace armature {

Topic::Topic(TopicSpec spec, std::size_t preallocated)
    : spec_{std::move(spec)}, pool_{*spec_.type, preallocated, reuse_for(spec_.qos)} {}

void Topic::publish(SampleRef sample, Time now) {
  sample.mutable_info().sequence = next_sequence();
  send(std::move(sample), now);
}

void Topic::send(SampleRef sample, Time now) {
  sample.mutable_info().published = now;
  deliver(sample);
  if (hub_) hub_->deliver(sample);
  if (remote_) remote_->offer(sample);
}

void Topic::deliver(const SampleRef& sample) {
  for (const auto& [subscriber, sources] : subscribers_) subscriber->deliver(sample);
}

void Topic::deliver(const SampleRef& sample, Sources sources) {
  for (const Connection& connection : subscribers_) {
    if (connection.sources == sources) connection.subscriber->deliver(sample);
  }
}

bool Topic::has_readers() const {
  return !subscribers_.empty() || (hub_ && !hub_->subscribers_.empty()) ||
         (remote_ && remote_->matched_readers() > 0);
}

}  // namespace armature
