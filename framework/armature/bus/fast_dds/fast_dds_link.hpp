// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <mutex>
#include <vector>

#include "armature/bus/fast_dds/conflicts.hpp"
#include "armature/bus/fast_dds/egress.hpp"
#include "armature/bus/fast_dds/participant.hpp"
#include "armature/bus/transport.hpp"

namespace armature ARMATURE_EXPORT {

/// What the transport, its writers and its readers share; they hold it together, so the order in
/// which a program lets go of them does not matter.
struct FastDdsLink {
  FastDdsLink(EndpointTag own, std::function<void(const TransportEvent&)> on_event)
      : tag{own}, conflicts{own, std::move(on_event)} {}

  EndpointTag tag;
  Conflicts conflicts;
  /// Whether DDS carries the stamps of the deployment's clock, for its other processes.
  bool shared_clock = true;
  std::function<Time()> now;
  std::mutex pools_mutex;
  std::vector<std::unique_ptr<SamplePool>> pools;  // of the readers; may outlive them
  std::unique_ptr<Participant> participant;        // goes first: its threads use the rest
  std::unique_ptr<Egress> egress, picture_egress;

  /// Pictures have a thread of their own: while DDS sends parts of one again, or the network takes
  /// no more, its writer waits, and a command must not.
  Egress& egress_for(QosProfile qos) {
    auto& one = qos == QosProfile::sensor ? picture_egress : egress;
    if (!one) one = std::make_unique<Egress>();
    return *one;
  }

  EndpointTag tag_for(const MessageType& type) const {
    EndpointTag made = tag;
    made.layout = type.layout;
    return made;
  }
  /// Whether the endpoint is one of the deployment's other processes.
  bool is_peer(const Guid& guid) const {
    const auto endpoint = participant->discovery().find(guid);
    return endpoint && same_deployment(endpoint->tag, tag);
  }
};

Expected<std::unique_ptr<RemoteWriter>> make_fast_dds_writer(std::shared_ptr<FastDdsLink> link,
                                                             const TopicSpec& topic);
Expected<std::unique_ptr<RemoteReader>> make_fast_dds_reader(
    std::shared_ptr<FastDdsLink> link, const TopicSpec& topic, bool same_deployment_only,
    std::function<void(SampleRef)> deliver);

/// "reliability", for the policies that can keep a writer and a reader apart.
std::string qos_policy_name(std::uint32_t policy_id);
/// Who else is on the topic: "deployment 'a', participant 'b'".
std::string owners_on(const std::string& topic, bool writers, const Discovery& discovery);

}  // namespace armature
