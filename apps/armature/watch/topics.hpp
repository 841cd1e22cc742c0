// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string>

#include "watch/outsider.hpp"

namespace armature {

/// How `armature topic` watches.
struct TopicOptions : WatchOptions {
  std::string topic;         // "/dental_lamp/arm/measured_js"
  std::uint64_t count = 0;   // 0: until interrupted
  bool best_effort = false;  // a sample that was lost is not asked for again
  bool full = false;         // long byte arrays in full
};

int list_topics(const TopicOptions& options);
/// Who writes and reads a topic, and with which quality of service.
int describe_topic(const TopicOptions& options);
int echo_topic(const TopicOptions& options);

/// What of a topic's samples is measured.
enum class TopicMeasure { rate, bandwidth, delay };
int measure_topic(TopicMeasure what, const TopicOptions& options);

}  // namespace armature
