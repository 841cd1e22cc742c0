// SPDX-License-Identifier: Apache-2.0
#include "armature/bus/fast_dds/discovery.hpp"

namespace armature {

void Discovery::participant_found(const GuidPrefix& participant, const std::string& name) {
  const std::scoped_lock lock{mutex_};
  participants_[participant] = name;
}

void Discovery::participant_gone(const GuidPrefix& participant, bool lost) {
  std::string name;
  {
    const std::scoped_lock lock{mutex_};
    name = name_of(participant);
    participants_.erase(participant);
    std::erase_if(endpoints_,
                  [&](const auto& entry) { return entry.first.participant == participant; });
  }
  if (lost && watcher_.participant_lost) watcher_.participant_lost(name);
}

void Discovery::endpoint_found(Endpoint endpoint) {
  {
    const std::scoped_lock lock{mutex_};
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

std::string Discovery::owner(const Endpoint& endpoint) const {
  if (endpoint.tag.ours) return "deployment '" + endpoint.tag.deployment + "'";
  const std::scoped_lock lock{mutex_};
  return name_of(endpoint.guid.participant);
}

std::string Discovery::name_of(const GuidPrefix& participant) const {
  const auto found = participants_.find(participant);
  if (found == participants_.end() || found->second.empty()) return "an unnamed participant";
  return "participant '" + found->second + "'";
}

}  // namespace armature
