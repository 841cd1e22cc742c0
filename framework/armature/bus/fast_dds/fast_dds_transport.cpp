// SPDX-License-Identifier: Apache-2.0
#include "armature/bus/fast_dds/fast_dds_transport.hpp"

#include <unistd.h>

#include <chrono>
#include <cstdlib>
#include <set>
#include <utility>

#include "armature/bus/fast_dds/fast_dds_link.hpp"

namespace armature {
namespace {

Time system_now() {
  return Time{
      std::chrono::duration_cast<Duration>(std::chrono::system_clock::now().time_since_epoch())
          .count()};
}

/// What others call this process by: "armature lamp, process 'vision'".
std::string participant_name(const TransportOptions& options) {
  std::string name = "armature " + options.deployment;
  if (!options.process.empty()) {
    name += ", process '" + options.process + "'";
  }
  return name;
}

Discovery::Watcher watch(const std::shared_ptr<FastDdsLink>& link) {
  // Raw: the link owns the participant that calls these.
  FastDdsLink* raw = link.get();
  return {.endpoint_found =
              [raw](const Endpoint& other, const Discovery& discovery) {
                raw->conflicts.endpoint_found(other, discovery);
              },
          .is_peer = [raw](const EndpointTag& tag) { return same_deployment(tag, raw->tag); },
          .participant_lost =
              [raw](const std::string& owner, bool of_peer) {
                raw->conflicts.report_always({TransportEvent::Kind::peer_lost, "",
                                              owner + " fell silent: its process died or hangs",
                                              of_peer});
              }};
}

}  // namespace

Expected<std::unique_ptr<Transport>> FastDdsTransport::make(const TransportOptions& options) {
  return make(options, SharedMemory{});
}

Expected<std::unique_ptr<Transport>> FastDdsTransport::make(const TransportOptions& options,
                                                            const SharedMemory& shared_memory,
                                                            std::uint32_t receive_buffer) {
  const EndpointTag tag{.ours = true,
                        .deployment = options.deployment,
                        .fingerprint = options.fingerprint,
                        .run = options.run,
                        .layout = 0};
  auto link = std::make_shared<FastDdsLink>(tag, options.on_event);
  link->shared_clock = !options.simulated;
  link->now = options.now ? options.now : system_now;
  const auto note = [raw = link.get()](const std::string& text) {
    raw->conflicts.report({TransportEvent::Kind::note, "", text});
  };
  auto participant = Participant::make({.network = options.network,
                                        .name = participant_name(options),
                                        .watcher = watch(link),
                                        .on_note = note,
                                        .shared_memory = shared_memory,
                                        .receive_buffer = receive_buffer});
  if (!participant) return tl::unexpected{participant.error()};
  link->participant = std::move(*participant);
  return std::make_unique<FastDdsTransport>(std::move(link));
}

Expected<std::unique_ptr<RemoteWriter>> FastDdsTransport::advertise(const TopicSpec& topic) {
  return make_fast_dds_writer(link_, topic);
}

Expected<std::unique_ptr<RemoteReader>> FastDdsTransport::subscribe(
    const TopicSpec& topic, bool same_deployment_only, std::function<void(SampleRef)> deliver) {
  return make_fast_dds_reader(link_, topic, same_deployment_only, std::move(deliver));
}

std::string qos_policy_name(std::uint32_t policy_id) {
  // Numbers of the DDS specification, table 2.2.3.
  switch (policy_id) {
    case 2: return "durability";
    case 4: return "deadline";
    case 5: return "latency budget";
    case 6: return "ownership";
    case 8: return "liveliness";
    case 11: return "reliability";
    case 12: return "destination order";
    case 23: return "data representation";
    default: return "policy " + std::to_string(policy_id);
  }
}

std::string owners_on(const std::string& topic, bool writers, const Discovery& discovery) {
  std::set<std::string> owners;
  for (const Endpoint& endpoint : discovery.endpoints()) {
    if (endpoint.topic == topic && endpoint.writes == writers) {
      owners.insert(discovery.owner(endpoint));
    }
  }
  std::string text;
  for (const std::string& owner : owners) text += (text.empty() ? "" : ", ") + owner;
  return text;
}

}  // namespace armature
