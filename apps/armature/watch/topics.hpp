// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string>

#include "armature/bus/network.hpp"

namespace armature {

/// How `armature topic` watches; it joins the domain as a stranger and reads, nothing else.
struct TopicOptions {
  NetworkOptions network;
  std::string topic;         // "/dental_lamp/arm/measured_js"
  std::uint64_t count = 0;   // 0: until interrupted
  double timeout_s = 0;      // 0: never
  bool best_effort = false;  // a sample that was lost is not asked for again
  bool json = false;
  bool full = false;  // long byte arrays in full
};

int list_topics(const TopicOptions& options);
int echo_topic(const TopicOptions& options);
int topic_rate(const TopicOptions& options);

}  // namespace armature
