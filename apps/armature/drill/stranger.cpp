// SPDX-License-Identifier: Apache-2.0
#include "drill/stranger.hpp"

#include <deque>
#include <string>
#include <thread>
#include <utility>

#include "armature/bus/topic.hpp"
#include "armature/messages/sensor_msgs.hpp"
#include "armature/messages/stamp.hpp"
#include "armature/runtime/execution/clock.hpp"

namespace armature::drill {
namespace {

/// Of the arm that has as many joints as the last one heard of.
void write_elsewhere(const std::vector<ArmRecord>& records, Time now, msg::JointState& message) {
  constexpr double kOff = 0.5;
  set_stamp(message.header_().stamp_(), now);
  for (const ArmRecord& record : records) {
    if (record.samples().empty()) continue;
    message.position_() = record.samples().back().q;
    message.velocity_().assign(message.position_().size(), 0.0);
    for (double& position : message.position_()) position += kOff;
  }
}

}  // namespace

void write_as_stranger(PluginRegistry& plugins, const DrilledDeployment& deployment, int domain,
                       const std::vector<ArmRecord>& records, Duration duration) {
  const SystemClock clock;
  const TransportOptions options{.network = {.domain = domain},
                                 .deployment = "stranger",
                                 .fingerprint = std::string(64, '0'),
                                 .on_event = [](const TransportEvent&) {},
                                 .now = [&clock] { return clock.now(); }};
  auto transport = plugins.make<Transport>("transport/fast_dds", options);
  if (!transport) throw PluginError("a stranger cannot join: " + transport.error().text);
  constexpr std::size_t kSamples = 16;
  std::deque<Topic> topics;  // go before the transport
  for (const TopicSpec& input : deployment.inputs) {
    auto writer = (*transport)->advertise(input);
    if (!writer) throw PluginError("a stranger cannot write: " + writer.error().text);
    topics.emplace_back(input, kSamples).attach(std::move(*writer));
  }
  for (const Time end = clock.now() + duration; clock.now() < end;) {
    for (Topic& topic : topics) {
      SampleRef sample = topic.loan();
      if (topic.spec().type == &message_type<msg::JointState>()) {
        write_elsewhere(records, clock.now(),
                        *static_cast<msg::JointState*>(sample.mutable_message()));
      }
      topic.publish(std::move(sample), clock.now());
    }
    std::this_thread::sleep_for(std::chrono::milliseconds{20});
  }
}

}  // namespace armature::drill
