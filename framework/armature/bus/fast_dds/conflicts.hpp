// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <mutex>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include "armature/bus/fast_dds/discovery.hpp"
#include "armature/bus/transport.hpp"
#include "armature/values/recent.hpp"

namespace armature ARMATURE_EXPORT {

/// An endpoint of this process, as far as conflicts go.
struct OwnEndpoint {
  bool writes = false;
  TopicSpec topic;
  bool same_deployment_only = false;
};

/// Compares the endpoints of others with ours and reports, once each, what DDS is silent about or
/// tells without names. Any thread.
class Conflicts {
 public:
  Conflicts(EndpointTag own, std::function<void(const TransportEvent&)> on_event)
      : own_{std::move(own)}, on_event_{std::move(on_event)} {}

  /// The readers of a topic are added before its writers: only then is it known that nobody reads.
  void own_endpoint_added(const OwnEndpoint& added, const Discovery& discovery);
  void endpoint_found(const Endpoint& other, const Discovery& discovery);

  /// Whether samples of that writer must not reach a reader of ours.
  bool refuses(const Endpoint& writer, const OwnEndpoint& reader) const;
  /// Reports `event` unless the same was reported before, and not a thousand others since.
  void report(const TransportEvent& event);
  /// What may happen again: a peer that was lost.
  void report_always(const TransportEvent& event) const;

 private:
  std::vector<OwnEndpoint> own_on(const std::string& topic) const;
  void tell_second_writer(const std::vector<OwnEndpoint>& own, const Endpoint& other,
                          const Discovery& discovery);
  void compare(const OwnEndpoint& own, const Endpoint& other, const Discovery& discovery);

  EndpointTag own_;
  std::function<void(const TransportEvent&)> on_event_;
  mutable std::mutex mutex_;
  std::vector<OwnEndpoint> endpoints_;
  Recent<std::pair<TransportEvent::Kind, std::string>, std::monostate> reported_{2000};
};

}  // namespace armature
