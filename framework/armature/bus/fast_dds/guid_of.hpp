// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <fastdds/rtps/common/Guid.h>

#include <algorithm>
#include <iterator>

#include "armature/bus/fast_dds/discovery.hpp"

namespace armature ARMATURE_EXPORT {

/// Fast DDS's identities as ours, which need no Fast DDS header.
inline GuidPrefix prefix_of(const eprosima::fastrtps::rtps::GuidPrefix_t& prefix) {
  GuidPrefix copy{};
  std::copy(std::begin(prefix.value), std::end(prefix.value), copy.begin());
  return copy;
}

inline Guid guid_of(const eprosima::fastrtps::rtps::GUID_t& guid) {
  Guid copy{.participant = prefix_of(guid.guidPrefix)};
  std::copy(std::begin(guid.entityId.value), std::end(guid.entityId.value), copy.entity.begin());
  return copy;
}

}  // namespace armature
