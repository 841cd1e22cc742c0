// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>

namespace armature {

/// Whether an IPv4 address is one of this machine's: a loopback one, or that of an interface.
bool is_local_address(const std::array<std::uint8_t, 4>& address);

}  // namespace armature
