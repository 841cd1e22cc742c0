// SPDX-License-Identifier: Apache-2.0
#include "armature/bus/fast_dds/discovery.hpp"

#include <algorithm>
#include <utility>

namespace armature {

void Discovery::participant_found(const GuidPrefix& participant, ParticipantIdentity identity) {
  const std::scoped_lock lock{mutex_};
  participants_[participant] = std::move(identity);
}

bool Discovery::knows(const GuidPrefix& participant) const {
  const std::scoped_lock lock{mutex_};
  return participants_.contains(participant);
}

bool Discovery::ignore(const GuidPrefix& participant) {
  const std::scoped_lock lock{mutex_};
  return ignored_.insert(participant).second;
}

bool Discovery::is_ignored(const GuidPrefix& participant) const {
  const std::scoped_lock lock{mutex_};
  return ignored_.contains(participant);
}

void Discovery::participant_gone(const GuidPrefix& participant, bool lost) {
  std::string name;
  bool of_peer = false;
  {
    const std::scoped_lock lock{mutex_};
    name = name_of(participant) + place_of(participant);
    of_peer = std::ranges::any_of(endpoints_, [&](const auto& entry) {
      return entry.first.participant == participant && watcher_.is_peer &&
             watcher_.is_peer(entry.second.tag);
    });
    const bool is_missed = ignored_.erase(participant) == 0;
    lost = lost && is_missed;
    participants_.erase(participant);
    std::erase_if(endpoints_,
                  [&](const auto& entry) { return entry.first.participant == participant; });
  }
  if (lost && watcher_.participant_lost) watcher_.participant_lost(name, of_peer);
}

void Discovery::endpoint_found(Endpoint endpoint) {
  {
    const std::scoped_lock lock{mutex_};
    if (ignored_.contains(endpoint.guid.participant)) return;
    endpoints_[endpoint.guid] = endpoint;
  }
  if (watcher_.endpoint_found) watcher_.endpoint_found(endpoint, *this);
}

void Discovery::endpoint_gone(const Guid& guid) {
  const std::scoped_lock lock{mutex_};
  endpoints_.erase(guid);
}

std::vector<Endpoint> Discovery::endpoints() const {
  const std::scoped_lock lock{mutex_};
  std::vector<Endpoint> all;
  for (const auto& [guid, endpoint] : endpoints_) all.push_back(endpoint);
  return all;
}

std::optional<Endpoint> Discovery::find(const Guid& guid) const {
  const std::scoped_lock lock{mutex_};
  const auto found = endpoints_.find(guid);
  return found == endpoints_.end() ? std::nullopt : std::optional{found->second};
}

std::string Discovery::who(const GuidPrefix& participant) const {
  const std::scoped_lock lock{mutex_};
  return name_of(participant) + place_of(participant);
}

std::string Discovery::owner(const Endpoint& endpoint) const {
  const std::scoped_lock lock{mutex_};
  const GuidPrefix& participant = endpoint.guid.participant;
  const std::string who =
      endpoint.tag.ours ? "deployment '" + endpoint.tag.deployment + "'" + process_of(participant)
                        : name_of(participant);
  return who + place_of(participant);
}

std::string Discovery::process_of(const GuidPrefix& participant) const {
  const auto found = participants_.find(participant);
  if (found == participants_.end()) return "";
  const std::size_t process = found->second.name.find(", process '");
  return process == std::string::npos ? "" : found->second.name.substr(process);
}

std::string Discovery::name_of(const GuidPrefix& participant) const {
  const auto found = participants_.find(participant);
  if (found == participants_.end() || found->second.name.empty()) return "an unnamed participant";
  return "participant '" + found->second.name + "'";
}

std::string Discovery::place_of(const GuidPrefix& participant) const {
  const auto found = participants_.find(participant);
  if (found == participants_.end() || found->second.pid.empty()) return "";
  const auto& [name, host, pid] = found->second;
  return " (pid " + pid + (host.empty() ? "" : " on " + host) + ")";
}

}  // namespace armature
