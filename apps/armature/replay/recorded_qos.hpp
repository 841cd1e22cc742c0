// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "armature/bus/qos.hpp"
#include "armature/recording/mcap.hpp"

namespace armature {

/// With which quality a recorded topic is shown again. Everything is watched and nothing is
/// commanded: samples do not expire.
QosProfile replayed_profile(const McapChannel& channel);

}  // namespace armature
