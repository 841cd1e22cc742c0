// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <compare>
#include <cstdint>
#include <functional>
#include <map>
#include <mutex>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "armature/bus/fast_dds/endpoint_tag.hpp"

namespace armature ARMATURE_EXPORT {

/// The identity of a DDS participant, and of one of its writers or readers.
using GuidPrefix = std::array<std::uint8_t, 12>;
struct Guid {
  GuidPrefix participant{};
  std::array<std::uint8_t, 4> entity{};
  friend auto operator<=>(const Guid&, const Guid&) = default;
};

/// What a participant says of itself; empty where it says nothing.
struct ParticipantIdentity {
  std::string name;
  std::string host;
  std::string pid;
};

/// A writer or reader of another participant.
struct Endpoint {
  Guid guid;
  bool writes = false;
  std::string topic;  // "rt/dental_lamp/arm/measured_js"
  std::string type;   // DDS name
  bool reliable = false;
  bool transient_local = false;
  EndpointTag tag;
};

/// What is known of other participants. Filled by the listener of our participant on its threads;
/// read from any thread.
class Discovery {
 public:
  /// Called on a DDS thread after the change was noted; must only enqueue.
  struct Watcher {
    std::function<void(const Endpoint&, const Discovery&)> endpoint_found;
    /// Whether an endpoint is of one of our deployment's other processes.
    std::function<bool(const EndpointTag&)> is_peer = {};
    /// A participant that fell silent, not one that said goodbye.
    std::function<void(const std::string& owner, bool of_peer)> participant_lost = {};
  };

  explicit Discovery(Watcher watcher) : watcher_{std::move(watcher)} {}

  void participant_found(const GuidPrefix& participant, ParticipantIdentity identity);
  bool knows(const GuidPrefix& participant) const;
  /// Nothing is known of its endpoints, and no sample of it is taken. False: it was ignored before.
  bool ignore(const GuidPrefix& participant);
  bool is_ignored(const GuidPrefix& participant) const;
  void participant_gone(const GuidPrefix& participant, bool lost);
  void endpoint_found(Endpoint endpoint);
  void endpoint_gone(const Guid& guid);

  std::vector<Endpoint> endpoints() const;
  std::optional<Endpoint> find(const Guid& guid) const;
  /// For humans: "participant 'talker' (pid 123 on theatre-2)".
  std::string who(const GuidPrefix& participant) const;
  /// For humans: "deployment 'dental_lamp', process 'vision' (pid 123 on theatre-2)", or the
  /// participant's name.
  std::string owner(const Endpoint& endpoint) const;

 private:
  std::string name_of(const GuidPrefix& participant) const;
  /// ", process 'vision'" of a participant of ours that says so, else "".
  std::string process_of(const GuidPrefix& participant) const;
  std::string place_of(const GuidPrefix& participant) const;

  Watcher watcher_;
  mutable std::mutex mutex_;
  std::map<Guid, Endpoint> endpoints_;
  std::map<GuidPrefix, ParticipantIdentity> participants_;
  std::set<GuidPrefix> ignored_;
};

}  // namespace armature
