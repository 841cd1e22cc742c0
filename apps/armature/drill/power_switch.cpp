// SPDX-License-Identifier: Apache-2.0
#include "drill/power_switch.hpp"

#include <string>
#include <utility>

#include "armature/messages/std_msgs.hpp"

namespace armature::drill {

PowerSwitch::PowerSwitch(PluginRegistry& plugins, const std::vector<DrilledArm>& arms, int domain) {
  const TransportOptions options{.network = {.domain = domain},
                                 .deployment = "power_switch",
                                 .fingerprint = std::string(64, '0'),
                                 .on_event = [](const TransportEvent&) {},
                                 .now = [this] { return clock_.now(); }};
  auto transport = plugins.make<Transport>("transport/fast_dds", options);
  if (!transport) throw PluginError("a power switch cannot join: " + transport.error().text);
  transport_ = std::move(*transport);
  constexpr std::size_t kSamples = 4;
  for (const DrilledArm& arm : arms) {
    const TopicSpec spec{.name = "rt" + arm.power_topic,
                         .type = &message_type<msg::Bool>(),
                         .qos = QosProfile::latched};
    auto writer = transport_->advertise(spec);
    if (!writer) throw PluginError("a power switch cannot write: " + writer.error().text);
    topics_.emplace_back(spec, kSamples).attach(std::move(*writer));
  }
}

void PowerSwitch::turn(bool on) {
  for (Topic& topic : topics_) {
    SampleRef sample = topic.loan();
    static_cast<msg::Bool*>(sample.mutable_message())->data_(on);
    topic.publish(std::move(sample), clock_.now());
  }
}

}  // namespace armature::drill
