// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <memory>
#include <string_view>
#include <vector>

#include "armature/bus/qos.hpp"
#include "armature/values/expected.hpp"

namespace armature ARMATURE_EXPORT {

struct PlainExchangeOptions {
  int domain = 0;
  bool answers = false;  // this end answers with a message of the same size; the other one asks
};

/// A sensor_msgs/Image that goes to another process, and one that comes back, as in a program which
/// uses Fast DDS alone: fastcdr writes the message into the payload, and the reader's listener
/// answers. It has the transports and the QoS of a topic. `armature bench bus` compares topics with
/// it.
class PlainExchange {
 public:
  static constexpr std::string_view kKind = "exchange";
  using Factory = Expected<std::unique_ptr<PlainExchange>> (*)(const PlainExchangeOptions&);

  static Expected<std::unique_ptr<PlainExchange>> make(const PlainExchangeOptions& options);
  virtual ~PlainExchange() = default;

  /// Whether this end has met the other one.
  virtual bool met() const = 0;
  /// Asks `count` times, each time when the answer to the one before is there. `bytes` is the size
  /// of the picture, which goes with `qos`: `state` or `sensor`. The times from the call of write()
  /// to the listener's call [s]; fewer when an answer did not come within a second.
  virtual std::vector<double> round_trips(QosProfile qos, std::size_t bytes, int count) = 0;
};

}  // namespace armature
