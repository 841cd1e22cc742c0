// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <span>

#include "armature/messages/type_description.hpp"

namespace armature ARMATURE_EXPORT {

/// Whether `cdr` (with its encapsulation header) is an encoding of `type`: every length that stands
/// in it fits into what is there. Decoding what passed allocates no more than the bytes announce.
/// The reason names the field and the byte.
Expected<void> check_cdr(const TypeDescription& type, std::span<const std::byte> cdr);

}  // namespace armature
