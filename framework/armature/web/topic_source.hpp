// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <span>
#include <string>
#include <vector>

#include "armature/values/time.hpp"

namespace armature ARMATURE_EXPORT {

/// What browsers are shown: topics that come and go, and their messages. All functions are called
/// by one thread.
class TopicSource {
 public:
  struct Topic {
    std::string name;       // "/dental_lamp/arm/measured_js"
    std::string type;       // by which schema_of() knows it
    std::size_t keeps = 0;  // so many of the last messages are given to those who come later, too
  };
  /// What messages of a type look like.
  struct Schema {
    std::string name;  // "sensor_msgs/msg/JointState"
    std::string text;  // as ros2msg
  };
  struct Message {
    Time time;
    std::span<const std::byte> cdr;  // with encapsulation header; valid during the call
    /// Messages before it that did not arrive.
    std::uint64_t lost_before = 0;
  };
  using OnMessage = std::function<void(const Message&)>;

  virtual ~TopicSource() = default;

  /// Those that can be shown now.
  virtual std::vector<Topic> topics() const = 0;
  virtual Schema schema_of(const Topic& topic) const = 0;
  /// Hands on the messages of a topic from now on, by any thread, one at a time. False when nobody
  /// writes it any more.
  virtual bool watch(const std::string& name, OnMessage on_message) = 0;
  /// No message of it is handed on when this has returned.
  virtual void unwatch(const std::string& name) = 0;
};

}  // namespace armature
