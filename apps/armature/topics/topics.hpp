// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string>
#include <vector>

namespace armature {

/// How `armature topic` watches; it joins the domain as a stranger and reads, nothing else.
struct TopicOptions {
  int domain = 0;
  std::vector<std::string> interfaces;  // joined beside loopback
  std::string topic;                    // "/dental_lamp/arm/measured_js"
  std::uint64_t count = 0;              // 0: until interrupted
  double timeout_s = 0;                 // 0: never
  bool json = false;
  bool full = false;  // long byte arrays in full
};

int list_topics(const TopicOptions& options);
int echo_topic(const TopicOptions& options);
int topic_rate(const TopicOptions& options);

}  // namespace armature
