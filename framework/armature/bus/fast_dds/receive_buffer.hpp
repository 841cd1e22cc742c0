// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

namespace armature ARMATURE_EXPORT {

/// What a process asks the system for, to keep datagrams until it reads them [B]: a pair of
/// pictures at once, with room for what the system counts with them. It gets no more than
/// net.core.rmem_max, which is 212,992 where nobody has raised it: less than a picture.
inline constexpr std::uint32_t kReceiveBuffer = 4U << 20;

}  // namespace armature
