// SPDX-License-Identifier: Apache-2.0
#include "armature/runtime/execution/clock_publisher.hpp"

#include "armature/messages/stamp.hpp"
#include "armature/runtime/component/setup.hpp"

namespace armature {
namespace {

constexpr Duration kPeriod = seconds(0.01);

// The profile `sensor`: ROS reads /clock with best effort and wants the newest only.
constexpr const char* kManifest = R"(
armature_plugin: 1
id: runtime/clock
kind: component
doc: Tells the simulated time.
out:
  clock: {type: rosgraph_msgs/Clock, topic: /clock, qos: sensor, doc: "Now"}
)";

}  // namespace

const PluginManifest& ClockPublisher::manifest() {
  static const PluginManifest manifest = parse_own_manifest(kManifest);
  return manifest;
}

ClockPublisher::ClockPublisher(Setup& setup)
    : Component{setup}, rate_limiter_{kPeriod}, clock_{setup.output<msg::Clock>("clock")} {
  setup.activate_every(kPeriod);
}

void ClockPublisher::step(Time now) {
  if (!rate_limiter_.due(now) || !clock_.has_subscribers()) return;
  auto message = clock_.loan();
  set_stamp(message->clock_(), now);
  message.publish();
}

}  // namespace armature
