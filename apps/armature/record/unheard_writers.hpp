// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>

#include "armature/bus/fast_dds/observer.hpp"

namespace armature {

/// The number of writers of `topic` that are not heard by a reader with the type and the QoS of the
/// writer `read_like`.
inline int unheard_writers(const ObservedTopic& topic, const ObservedEndpoint& read_like) {
  const auto is_unheard = [&](const ObservedEndpoint& endpoint) {
    return endpoint.writes &&
           (endpoint.type != read_like.type || (read_like.reliable && !endpoint.reliable) ||
            (read_like.transient_local && !endpoint.transient_local));
  };
  return static_cast<int>(std::ranges::count_if(topic.endpoints, is_unheard));
}

}  // namespace armature
